#include "engine/mesh/remesh_tree.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr std::size_t kBuildLeaf = 4, kFullLeaf = 12;

bool same(const Box& a, const Box& b) {
  return a.low == b.low && a.high == b.high;
}

}  // namespace

Box box_of(const std::array<Vec3, 3>& corners) {
  Box box;
  for (const Vec3& p : corners) box.grow(p);
  return box;
}

void FaceTree::build(const EditMesh& mesh) {
  nodes_.assign(1, {});
  box_.assign(mesh.triangle.size(), {});
  leaf_.assign(mesh.triangle.size(), kNone);
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
    if (mesh.alive(t) && !mesh.ghost(t)) {
      box_[t] = box_of(mesh.corners(t));
      leaf_[t] = 0;
      nodes_[0].faces.push_back(t);
      nodes_[0].box.grow(box_[t]);
    }
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) split_leaf(n, kBuildLeaf);
}

// Two new leaves when there are more than `most` faces; halves by the boxes' centres along the widest axis.
void FaceTree::split_leaf(std::uint32_t leaf, std::size_t most) {
  if (nodes_[leaf].faces.size() <= most) return;
  std::vector<std::uint32_t> faces = std::move(nodes_[leaf].faces);
  nodes_[leaf].faces.clear();
  Box centres;
  for (const std::uint32_t f : faces) centres.grow(box_[f].centre());
  const Vec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  const auto half = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
  std::nth_element(faces.begin(), half, faces.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Real ca = box_[a].low[axis] + box_[a].high[axis], cb = box_[b].low[axis] + box_[b].high[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const auto left = static_cast<std::uint32_t>(nodes_.size()), right = left + 1;
  nodes_.resize(nodes_.size() + 2);
  nodes_[leaf].left = left, nodes_[leaf].right = right;
  nodes_[left].parent = nodes_[right].parent = leaf;
  nodes_[left].faces.assign(faces.begin(), half);
  nodes_[right].faces.assign(half, faces.end());
  for (const std::uint32_t n : {left, right})
    for (const std::uint32_t f : nodes_[n].faces) leaf_[f] = n, nodes_[n].box.grow(box_[f]);
}

void FaceTree::refit(std::uint32_t node) {
  while (node != kNone) {
    Node& n = nodes_[node];
    Box box;
    if (n.left == kNone) {
      for (const std::uint32_t f : n.faces) box.grow(box_[f]);
    } else {
      box.grow(nodes_[n.left].box), box.grow(nodes_[n.right].box);
    }
    if (same(box, n.box)) return;
    n.box = box;
    node = n.parent;
  }
}

void FaceTree::add(const EditMesh& mesh, std::uint32_t face) {
  if (face >= box_.size()) box_.resize(face + 1), leaf_.resize(face + 1, kNone);
  box_[face] = box_of(mesh.corners(face));
  const Vec3 centre = box_[face].centre();
  // Down to the child whose box grows least (squared diagonal), ties to the nearer centre.
  std::uint32_t node = 0;
  while (nodes_[node].left != kNone) {
    Real cost[2], gap[2];
    const std::uint32_t child[2] = {nodes_[node].left, nodes_[node].right};
    for (int k = 0; k < 2; ++k) {
      Box grown = nodes_[child[k]].box;
      const Real before = grown.low.x > grown.high.x ? 0 : grown.diagonal();
      grown.grow(box_[face]);
      cost[k] = grown.diagonal() - before;
      gap[k] = distance2(nodes_[child[k]].box.centre(), centre);
    }
    node = cost[1] < cost[0] || (cost[1] == cost[0] && gap[1] < gap[0]) ? child[1] : child[0];
  }
  insert_into(node, face);
}

void FaceTree::insert_into(std::uint32_t leaf, std::uint32_t face) {
  nodes_[leaf].faces.push_back(face);
  leaf_[face] = leaf;
  refit(leaf);
  split_leaf(leaf, kFullLeaf);
}

void FaceTree::update(const EditMesh& mesh, std::uint32_t face) {
  box_[face] = box_of(mesh.corners(face));
  refit(leaf_[face]);
}

void FaceTree::remove(std::uint32_t face) {
  const std::uint32_t leaf = leaf_[face];
  auto& faces = nodes_[leaf].faces;
  faces.erase(std::find(faces.begin(), faces.end(), face));
  leaf_[face] = kNone;
  refit(leaf);
}

void FaceTree::overlapping(const Box& box, std::vector<std::uint32_t>& faces) const {
  faces.clear();
  // Depth first along an implicit stack: the tree may be deep where many faces were added to one place.
  thread_local std::vector<std::uint32_t> stack;
  stack.assign(1, 0u);
  while (!stack.empty()) {
    const Node& n = nodes_[stack.back()];
    stack.pop_back();
    if (!n.box.overlaps(box)) continue;
    if (n.left != kNone) {
      stack.push_back(n.right), stack.push_back(n.left);
      continue;
    }
    for (const std::uint32_t f : n.faces)
      if (box_[f].overlaps(box)) faces.push_back(f);
  }
}

}  // namespace sherd
