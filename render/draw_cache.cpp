#include "render/draw_cache.h"

#include "kernels/core/error.h"

namespace sherd {

DrawBuffer::DrawBuffer(const DrawMesh& mesh)
    : origin_(mesh.origin), box_(mesh.box), original_(mesh.original_indices), total_(mesh.indices.size()) {
  glGenVertexArrays(1, &array_);
  glBindVertexArray(array_);
  glGenBuffers(3, buffers_);
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(float)), mesh.vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
               mesh.indices.data(), GL_STATIC_DRAW);
  constexpr GLsizei kStride = 6 * sizeof(float);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride, reinterpret_cast<const void*>(3 * sizeof(float)));
  if (mesh.values.empty()) return;
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[2]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.values.size() * sizeof(float)), mesh.values.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, sizeof(float), nullptr);
}

DrawBuffer::~DrawBuffer() {
  glDeleteBuffers(3, buffers_);
  glDeleteVertexArrays(1, &array_);
}

void DrawBuffer::draw(std::size_t begin, std::size_t end) const {
  if (begin == end) return;
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - begin), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(begin * sizeof(std::uint32_t)));
}

std::vector<const DrawBuffer*> DrawCache::update(const Frame& frame) {
  for (auto& [key, entry] : entries_) entry.shown = false;
  std::vector<const DrawBuffer*> buffers;
  for (const FrameBody& body : frame.bodies) {
    Entry& entry = entries_[{body.id, body.mesh_version}];
    if (entry.mesh != body.mesh || entry.field != body.field) {
      if (entry.shown)
        throw InputError(fmt::format(
            "frame {}: two bodies have id {} and mesh version {} but different meshes or fields; give each its own id",
            frame.index, body.id, body.mesh_version));
      entry.mesh = body.mesh, entry.field = body.field;
      entry.buffer = std::make_unique<DrawBuffer>(make_draw_mesh(*body.mesh, body.field.get()));
    }
    entry.shown = true;
    buffers.push_back(entry.buffer.get());
  }
  std::erase_if(entries_, [](const auto& item) { return !item.second.shown; });
  return buffers;
}

}  // namespace sherd
