// Structure-of-arrays columns. A hot loop reads x, y, z as three plain arrays; everything else uses operator[] and
// set().
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

struct Vec3Column {
  std::vector<Real> x, y, z;

  Vec3Column() = default;
  explicit Vec3Column(std::size_t n) : x(n), y(n), z(n) {}
  std::size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  void add(std::size_t i, const Vec3& v) { x[i] += v.x, y[i] += v.y, z[i] += v.z; }
  void push_back(const Vec3& v) { x.push_back(v.x), y.push_back(v.y), z.push_back(v.z); }
  void resize(std::size_t n) { x.resize(n), y.resize(n), z.resize(n); }
  void reserve(std::size_t n) { x.reserve(n), y.reserve(n), z.reserve(n); }
  void clear() { x.clear(), y.clear(), z.clear(); }
  friend bool operator==(const Vec3Column&, const Vec3Column&) = default;
};

}  // namespace sherd
