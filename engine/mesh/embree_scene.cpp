#include "engine/mesh/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>

#include "engine/mesh/bvh.h"
#include "kernels/core/error.h"
#include "kernels/core/parallel.h"

namespace sherd {
namespace {

constexpr float kFloatSlack = 4e-6f;  // float error of unit-sized coordinates and their box distances, with margin

RTCDevice shared_device() {
  struct Device {
    RTCDevice handle = rtcNewDevice(nullptr);
    ~Device() {
      if (handle) rtcReleaseDevice(handle);
    }
  };
  static const Device device;
  SHERD_CHECK(device.handle != nullptr, "Embree gave no device");
  return device.handle;
}

struct QueryState {
  const SurfaceMesh* mesh;
  Vec3 point;
  Real scale;
  float slack;
  EmbreeScene::Closest best;
};

float query_radius(Real distance2, Real scale, float slack) {
  if (!(distance2 < std::numeric_limits<Real>::infinity())) return std::numeric_limits<float>::infinity();
  return static_cast<float>(std::sqrt(distance2) * scale) * (1 + kFloatSlack) + slack;
}

bool visit(RTCPointQueryFunctionArguments* args) {
  auto& state = *static_cast<QueryState*>(args->userPtr);
  const SurfaceMesh& m = *state.mesh;
  const Vec3 q = closest_point_on_triangle(state.point, m.corner(args->primID, 0), m.corner(args->primID, 1),
                                           m.corner(args->primID, 2));
  const Real d2 = distance2(state.point, q);
  if (d2 > state.best.distance2 || (d2 == state.best.distance2 && args->primID >= state.best.face)) return false;
  state.best = {q, args->primID, d2};
  args->query->radius = query_radius(d2, state.scale, state.slack);
  return true;
}

}  // namespace

struct EmbreeScene::Impl {
  SurfaceMesh mesh;
  Vec3 centre;
  Real scale = 1;
  RTCScene scene = nullptr;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }
  Vec3 to_unit(const Vec3& p) const { return (p - centre) * scale; }
};

EmbreeScene::EmbreeScene(const SurfaceMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->mesh.vertices = mesh.vertices;
  impl_->mesh.triangles = mesh.triangles;
  const Box box = bounding_box(mesh);
  if (mesh.triangle_count() == 0) return;
  impl_->centre = box.centre();
  impl_->scale = box.diagonal() > 0 ? 1 / box.diagonal() : 1;
  const RTCDevice device = shared_device();
  impl_->scene = rtcNewScene(device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), mesh.vertex_count()));
  auto* faces = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangle_count()));
  SHERD_CHECK(points && faces, "Embree gave no memory for {} triangles", mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 p = impl_->to_unit(mesh.vertices[i]);
    for (int k = 0; k < 3; ++k) *points++ = static_cast<float>(p[k]);
  }
  for (const Triangle& t : mesh.triangles) faces = std::copy(t.begin(), t.end(), faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);
  SHERD_CHECK(rtcGetDeviceError(device) == RTC_ERROR_NONE, "Embree could not build a scene of {} triangles",
              mesh.triangle_count());
}
EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

EmbreeScene::Closest EmbreeScene::closest(const Vec3& p, Real max_distance) const {
  QueryState state{&impl_->mesh, p, impl_->scale, kFloatSlack, {}};
  state.best.distance2 = max_distance * max_distance;
  if (impl_->scene == nullptr) return state.best;
  const Vec3 u = impl_->to_unit(p);
  RTCPointQuery query{};
  query.x = static_cast<float>(u.x), query.y = static_cast<float>(u.y), query.z = static_cast<float>(u.z);
  // A far point's float coordinates carry an error of their own size; the radius absorbs it, at worst visiting every
  // face.
  state.slack = kFloatSlack * static_cast<float>(std::max({1.0, std::abs(u.x), std::abs(u.y), std::abs(u.z)}));
  query.radius = query_radius(state.best.distance2, state.scale, state.slack);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, visit, &state);
  return state.best;
}

void EmbreeScene::closest(const Vec3Column& points, Real max_distance, std::vector<Closest>& result) const {
  result.resize(points.size());
  parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = closest(points[i], max_distance); });
}

EmbreeScene::Hit EmbreeScene::first_hit(const Vec3& origin, const Vec3& direction, Real t_min, Real t_max) const {
  Hit hit;
  if (impl_->scene == nullptr) return hit;
  const Vec3 o = impl_->to_unit(origin), d = direction * impl_->scale;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(o.x), ray.ray.org_y = static_cast<float>(o.y),
  ray.ray.org_z = static_cast<float>(o.z);
  ray.ray.dir_x = static_cast<float>(d.x), ray.ray.dir_y = static_cast<float>(d.y),
  ray.ray.dir_z = static_cast<float>(d.z);
  ray.ray.tnear = static_cast<float>(t_min), ray.ray.tfar = static_cast<float>(t_max);
  ray.ray.mask = 0xFFFFFFFFu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(impl_->scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &ray);
#endif
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.face = ray.hit.primID;
  const Vec3 n = impl_->mesh.area_normal2(hit.face);
  const Real along = dot(direction, n);
  hit.t = along != 0 ? dot(impl_->mesh.corner(hit.face, 0) - origin, n) / along : static_cast<Real>(ray.ray.tfar);
  return hit;
}

}  // namespace sherd
