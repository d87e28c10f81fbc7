#include "engine/contact/cache.h"

#include <algorithm>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {

void ContactCache::update(std::span<const Body> bodies) {
  std::map<BodyId, Entry> kept;
  for (const Body& body : bodies) {
    SHERD_CHECK(body.mesh != nullptr && body.mesh->vertex_count() > 0, "body '{}' has no mesh", body.name);
    const auto old = entries_.find(body.id);
    Entry entry;
    if (old != entries_.end() && old->second.version == body.mesh_version && old->second.mesh == body.mesh) {
      entry = std::move(old->second);
    } else {
      entry.version = body.mesh_version;
      entry.mesh = body.mesh;
      entry.bounds.box = bounding_box(*body.mesh);
      for (std::size_t v = 0; v < body.mesh->vertex_count(); ++v)
        entry.bounds.radius = std::max(entry.bounds.radius, distance(body.mesh->vertices[v], body.mass.centre));
      entry.bounds.thickness = 2 * signed_volume(*body.mesh) / surface_area(*body.mesh);
    }
    const bool unique = kept.emplace(body.id, std::move(entry)).second;
    SHERD_CHECK(unique, "two bodies share the id {}", body.id.value);
  }
  entries_.swap(kept);
}

const ContactCache::Entry& ContactCache::entry(const Body& body) const {
  const auto found = entries_.find(body.id);
  SHERD_CHECK(found != entries_.end(), "body '{}' is not in the contact cache", body.name);
  return found->second;
}

const ContactCache::Bounds& ContactCache::bounds(const Body& body) const {
  return entry(body).bounds;
}

void ContactCache::build(std::span<const Body> bodies, const std::vector<std::size_t>& which) {
  std::vector<Entry*> missing;
  for (const std::size_t b : which) {
    const auto found = entries_.find(bodies[b].id);
    SHERD_CHECK(found != entries_.end(), "body '{}' is not in the contact cache", bodies[b].name);
    if (!found->second.shape && std::find(missing.begin(), missing.end(), &found->second) == missing.end())
      missing.push_back(&found->second);
  }
  parallel_for(missing.size(), 1, [&](std::size_t i) {
    missing[i]->shape = std::make_unique<const CollisionShape>(missing[i]->mesh, options_);
  });
  builds_ += missing.size();
}

const CollisionShape& ContactCache::shape(const Body& body) const {
  const Entry& e = entry(body);
  SHERD_CHECK(e.shape != nullptr, "body '{}' has no collision shape yet", body.name);
  return *e.shape;
}

ContactHistory ContactCache::history() const {
  ContactHistory h{{}, builds_};
  for (const auto& [id, entry] : entries_)
    if (entry.shape) h.shapes[id] = entry.version;
  return h;
}

void ContactCache::restore(std::span<const Body> bodies, const ContactHistory& history) {
  entries_.clear();
  update(bodies);
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto held = history.shapes.find(bodies[i].id);
    if (held != history.shapes.end() && held->second == bodies[i].mesh_version) which.push_back(i);
  }
  build(bodies, which);
  builds_ = history.builds;
}

std::size_t ContactCache::shapes() const {
  return static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return e.second.shape != nullptr; }));
}

}  // namespace sherd
