// One crack from seed to fragments, judged by every law it has to obey.
#pragma once
#include <cstdint>
#include <string>

#include "engine/fracture/grow.h"
#include "engine/fracture/synthetic_fields.h"
#include "engine/fragment/cut.h"
#include "tools/campaign/specimen.h"

namespace sherd::campaign {

enum class CrackOutcome {
  kSeparated,  // went through, and cut the body in two or more
  kPierced,    // went through a handle: the body is whole, with one handle less
  kArrested,   // stopped inside: a notch
  kRejected,   // the seed opens no crack
  kDropped,    // growth, slab or cut refused: the body stays as it was
};
const char* to_string(CrackOutcome outcome);

struct CrackReport {
  CrackOutcome outcome = CrackOutcome::kDropped;
  int level = 0;                             // of the retry ladder
  int retreats = 0;                          // times the front went back to steer from farther away
  std::size_t wings = 0, wings_through = 0;  // left behind where a ring closed; of them, that went on to its wall
  Real angle = 0;       // mean over the sheet's area in the body between its normal and the field's, rad
  std::string reason;   // of a rejection, a drop or a ladder level above 0
  Rungs rungs;          // why each rung failed
  std::string invalid;  // a law that the accepted result breaks; empty: none
  bool body_changed = false;
  std::size_t sheet_triangles = 0, steps = 0, fragments = 0, touched = 0, stress_points = 0;
  int jitters = 0;
  Real area = 0, removed_volume = 0;        // of the crack inside the body, m^2; of body and slab together, m^3
  Real balance = 0;                         // |V(body) - V(fragments) - removed - dust| / V(body)
  Real grow_s = 0, cut_s = 0, check_s = 0;  // processor time of the thread
  std::uint64_t hash = 0;                   // of the outcome, the sheet and the fragments
};

struct Crack {
  CrackReport report;
  GrowthResult growth;
  SurfaceMesh slab;
  CutResult cut;  // of a crack that was not rejected or dropped
};

// Grows with slab and cut as the test of each rung, and checks. An exception is an invalid result, never thrown on.
// `options.accept` is overwritten. min_fragment_volume: of the body's.
Crack run_crack(const Specimen& specimen, const FunctionField& field, const CrackSeed& seed, GrowthOptions options,
                Real min_fragment_volume = 1e-5);

// Lets the wings of a closed ring go on in the fragments of `crack`, which are cut by those that go through. The first
// law that is broken, or nothing.
std::string grow_wings(const Specimen& specimen, const CrackField& field, const GrowthOptions& options,
                       Real min_fragment_volume, Crack& crack);
// The laws B1-B4 and V1 of a cut.
std::string check_cut_laws(const CutBody& body, const CutResult& cut);
// |V(body) - V(fragments) - V(removed) - V(dust)| / V(body)
Real balance_of(const CutBody& body, const CutResult& cut);
// Mean angle between the sheet's triangles inside the body and the field at their centroids, by area, rad.
Real mean_angle(const CrackSheet& sheet, const TriangleBvh& body, const CrackField& field);
// Area of the whole sheet, m^2.
Real sheet_area(const CrackSheet& sheet);

}  // namespace sherd::campaign
