// Collision shapes by (body, mesh version): built when a body first comes near another, kept while its mesh lives.
#pragma once
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/body/body.h"
#include "engine/contact/shape.h"

namespace sherd {

// Which shapes a cache has built: what its counts go on from when the shapes themselves are built anew.
struct ContactHistory {
  std::map<BodyId, std::uint32_t> shapes;  // held, with the mesh version they are of
  std::size_t builds = 0;                  // in all
};

class ContactCache {
 public:
  explicit ContactCache(const FieldOptions& options = {}) : options_(options) {}

  // Of the mesh, material coordinates, metres.
  struct Bounds {
    Box box;
    Real radius = 0;     // of the ball about the centre of mass that holds it
    Real thickness = 0;  // 2 volume / area: of a plate its thickness, of a ball two thirds of its radius
  };
  // Brings the cache up to date with the bodies: drops entries of bodies that are gone or changed their mesh, bounds
  // the new.
  void update(std::span<const Body> bodies);
  // Both need update() with this body before. build() makes the missing shapes of bodies[which], in parallel.
  const Bounds& bounds(const Body& body) const;
  void build(std::span<const Body> bodies, const std::vector<std::size_t>& which);
  const CollisionShape& shape(const Body& body) const;

  std::size_t shapes() const;                     // held now
  std::size_t builds() const { return builds_; }  // in all
  void clear() { entries_.clear(); }
  ContactHistory history() const;
  // Becomes the cache of these bodies that `history` was taken of.
  void restore(std::span<const Body> bodies, const ContactHistory& history);

 private:
  struct Entry {
    std::uint32_t version = 0;
    std::shared_ptr<const SurfaceMesh> mesh;  // held, so that its address identifies it
    Bounds bounds;
    std::unique_ptr<const CollisionShape> shape;
  };
  const Entry& entry(const Body& body) const;

  FieldOptions options_;
  std::map<BodyId, Entry> entries_;
  std::size_t builds_ = 0;
};

}  // namespace sherd
