// What stops or attracts a growing crack besides the body's surface (O14, O3): sheets of cracks that stopped in the
// body earlier and do not show in its mesh, and the walls that earlier cracks left on it.
#pragma once
#include <memory>
#include <vector>

#include "engine/fracture/sheet.h"

namespace sherd {

class Obstacles {
 public:
  void add_sheet(std::int32_t crack, const CrackSheet& sheet);
  // The faces of `body` with FaceKind::kCrack; fronts within 2.5 h turn to meet them at a right angle.
  void set_walls(const SurfaceMesh& body);

  struct Hit {
    Real t = 0;              // from + t * direction
    std::int32_t crack = 0;  // as given to add_sheet
    Vec3 normal;             // unit, of the sheet there
  };
  // The first sheet across the way from `from`, t in [0, length]; direction is a unit vector. A sheet that lies along
  // the plane with unit normal `plane` (less than 45 degrees off) is not in the way: cracks in one plane grow into one.
  bool first_hit(const Vec3& from, const Vec3& direction, Real length, const Vec3& plane, Hit& hit) const;
  // The nearest point of the walls no farther than `reach` from x.
  bool nearest_wall(const Vec3& x, Real reach, Vec3& point) const;

 private:
  struct Sheet {
    std::int32_t crack;
    std::shared_ptr<const TriangleBvh> tree;
  };
  std::vector<Sheet> sheets_;
  std::shared_ptr<const TriangleBvh> walls_;
};

// Does a crack with this unit normal run across one with that?
bool lies_across(const Vec3& normal, const Vec3& other);

}  // namespace sherd
