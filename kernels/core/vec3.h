// Three-vectors and 3x3 matrices, host/device neutral and generic in the number type (double, float, later a SIMD
// pack).
#pragma once
#include <cmath>
#include <cstddef>

#ifdef __CUDACC__
#define SHERD_HD __host__ __device__
#else
#define SHERD_HD
#endif

namespace sherd {

using Real = double;

template <class T>
struct Vec3T {
  T x{}, y{}, z{};

  SHERD_HD constexpr T& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  SHERD_HD constexpr const T& operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  SHERD_HD constexpr Vec3T& operator+=(const Vec3T& b) {
    x += b.x, y += b.y, z += b.z;
    return *this;
  }
  SHERD_HD constexpr Vec3T& operator-=(const Vec3T& b) {
    x -= b.x, y -= b.y, z -= b.z;
    return *this;
  }
  SHERD_HD constexpr Vec3T& operator*=(const T& s) {
    x *= s, y *= s, z *= s;
    return *this;
  }
  SHERD_HD friend constexpr Vec3T operator+(Vec3T a, const Vec3T& b) { return a += b; }
  SHERD_HD friend constexpr Vec3T operator-(Vec3T a, const Vec3T& b) { return a -= b; }
  SHERD_HD friend constexpr Vec3T operator-(const Vec3T& a) { return {-a.x, -a.y, -a.z}; }
  SHERD_HD friend constexpr Vec3T operator*(Vec3T a, const T& s) { return a *= s; }
  SHERD_HD friend constexpr Vec3T operator*(const T& s, Vec3T a) { return a *= s; }
  SHERD_HD friend constexpr Vec3T operator/(const Vec3T& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
  SHERD_HD friend constexpr bool operator==(const Vec3T& a, const Vec3T& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};
using Vec3 = Vec3T<Real>;

template <class T>
SHERD_HD constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
SHERD_HD constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
SHERD_HD constexpr T norm2(const Vec3T<T>& a) {
  return dot(a, a);
}
template <class T>
SHERD_HD T norm(const Vec3T<T>& a) {
  using std::sqrt;
  return sqrt(norm2(a));
}
// Zero stays zero.
template <class T>
SHERD_HD Vec3T<T> normalized(const Vec3T<T>& a) {
  const T l = norm(a);
  return l > T(0) ? a / l : Vec3T<T>{};
}
template <class T>
SHERD_HD constexpr T distance2(const Vec3T<T>& a, const Vec3T<T>& b) {
  return norm2(a - b);
}
template <class T>
SHERD_HD T distance(const Vec3T<T>& a, const Vec3T<T>& b) {
  return norm(a - b);
}
SHERD_HD inline Vec3 min(const Vec3& a, const Vec3& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
SHERD_HD inline Vec3 max(const Vec3& a, const Vec3& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
// Some unit vector perpendicular to the unit vector n (Duff et al. 2017, continuous except at n.z = 0).
SHERD_HD inline Vec3 any_perpendicular(const Vec3& n) {
  const Real s = n.z >= 0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
  return {1.0 + s * n.x * n.x * a, s * b, -s * n.x};
}

// Row major: m[i][j], (m v)_i = sum_j m_ij v_j.
template <class T>
struct Mat3T {
  T m[3][3]{};

  SHERD_HD constexpr T* operator[](int i) { return m[i]; }
  SHERD_HD constexpr const T* operator[](int i) const { return m[i]; }
  SHERD_HD static constexpr Mat3T identity() {
    Mat3T r;
    r.m[0][0] = r.m[1][1] = r.m[2][2] = T(1);
    return r;
  }
  SHERD_HD static constexpr Mat3T from_columns(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c) {
    Mat3T r;
    for (int i = 0; i < 3; ++i) r.m[i][0] = a[i], r.m[i][1] = b[i], r.m[i][2] = c[i];
    return r;
  }
  SHERD_HD constexpr Vec3T<T> row(int i) const { return {m[i][0], m[i][1], m[i][2]}; }
  SHERD_HD constexpr Vec3T<T> column(int j) const { return {m[0][j], m[1][j], m[2][j]}; }
  SHERD_HD constexpr Mat3T& operator+=(const Mat3T& b) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += b.m[i][j];
    return *this;
  }
  SHERD_HD constexpr Mat3T& operator*=(const T& s) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] *= s;
    return *this;
  }
  SHERD_HD friend constexpr Mat3T operator+(Mat3T a, const Mat3T& b) { return a += b; }
  SHERD_HD friend constexpr Mat3T operator-(Mat3T a, const Mat3T& b) { return a += b * T(-1); }
  SHERD_HD friend constexpr Mat3T operator*(Mat3T a, const T& s) { return a *= s; }
  SHERD_HD friend constexpr Mat3T operator*(const T& s, Mat3T a) { return a *= s; }
  SHERD_HD friend constexpr Vec3T<T> operator*(const Mat3T& a, const Vec3T<T>& v) {
    return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
            a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
  }
  SHERD_HD friend constexpr Mat3T operator*(const Mat3T& a, const Mat3T& b) {
    Mat3T r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return r;
  }
};
using Mat3 = Mat3T<Real>;

template <class T>
SHERD_HD constexpr Mat3T<T> transpose(const Mat3T<T>& a) {
  Mat3T<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[j][i];
  return r;
}
template <class T>
SHERD_HD constexpr T trace(const Mat3T<T>& a) {
  return a.m[0][0] + a.m[1][1] + a.m[2][2];
}
// a b^T
template <class T>
SHERD_HD constexpr Mat3T<T> outer(const Vec3T<T>& a, const Vec3T<T>& b) {
  Mat3T<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = a[i] * b[j];
  return r;
}
// [v]_x w = v x w
template <class T>
SHERD_HD constexpr Mat3T<T> cross_matrix(const Vec3T<T>& v) {
  Mat3T<T> r;
  r.m[0][1] = -v.z, r.m[0][2] = v.y, r.m[1][0] = v.z, r.m[1][2] = -v.x, r.m[2][0] = -v.y, r.m[2][1] = v.x;
  return r;
}
template <class T>
SHERD_HD constexpr T determinant(const Mat3T<T>& a) {
  return dot(a.row(0), cross(a.row(1), a.row(2)));
}
// Undefined (infinite) for a singular matrix; callers check determinant first where that can happen.
template <class T>
SHERD_HD constexpr Mat3T<T> inverse(const Mat3T<T>& a) {
  const Vec3T<T> c0 = cross(a.row(1), a.row(2)), c1 = cross(a.row(2), a.row(0)), c2 = cross(a.row(0), a.row(1));
  return Mat3T<T>::from_columns(c0, c1, c2) * (T(1) / dot(a.row(0), c0));
}

}  // namespace sherd
