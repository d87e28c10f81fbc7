// Boxes of the remesher's current faces, kept up to date while faces change: which faces are near a new one.
#pragma once
#include <vector>

#include "engine/mesh/remesh_mesh.h"

namespace sherd {

class FaceTree {
 public:
  void build(const EditMesh& mesh);                       // without ghosts
  void add(const EditMesh& mesh, std::uint32_t face);     // a new face
  void update(const EditMesh& mesh, std::uint32_t face);  // moved a little
  void remove(std::uint32_t face);
  // Faces whose boxes overlap `box`, in an order that depends on the sequence of calls only.
  void overlapping(const Box& box, std::vector<std::uint32_t>& faces) const;

 private:
  struct Node {
    Box box;
    std::uint32_t parent = kNone, left = kNone, right = kNone;  // left == kNone: leaf
    std::vector<std::uint32_t> faces;                           // of a leaf
  };
  void split_leaf(std::uint32_t leaf, std::size_t most);
  void refit(std::uint32_t node);
  void insert_into(std::uint32_t leaf, std::uint32_t face);

  std::vector<Node> nodes_;
  std::vector<Box> box_;             // per face
  std::vector<std::uint32_t> leaf_;  // per face
};

Box box_of(const std::array<Vec3, 3>& corners);

}  // namespace sherd
