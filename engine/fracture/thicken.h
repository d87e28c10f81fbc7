// Sheet to slab (the design's O9): full thickness where the crack leaves the body, zero at an arrested front.
#pragma once
#include <optional>

#include "engine/fracture/sheet.h"

namespace sherd {

class ScalarField;

struct SlabOptions {
  Real thickness = 0;                  // m
  const ScalarField* field = nullptr;  // m, of the place in material space; when given, instead of `thickness`
  std::int32_t crack = 0;              // id of the slab's faces
  std::uint16_t material = 1;          // of the slab's faces
  Real uv_scale = 1;                   // of the channel "uv": texture units per metre
};

// A closed, embedded, outward-oriented mesh around the sheet, or nothing with the reason when it is not embedded.
// Every face has FaceKind::kCrack, the crack id, the material and its side: +1 along the sheet's normal, -1 against it,
// 0 on the rim. Channel "uv": the corners projected along the sheet's mean normal, so that the two walls match.
std::optional<SurfaceMesh> thicken(const CrackSheet& sheet, const SlabOptions& options, std::string& reason);
// Of one thickness.
std::optional<SurfaceMesh> thicken(const CrackSheet& sheet, Real thickness, std::int32_t crack_id, std::string& reason);

}  // namespace sherd
