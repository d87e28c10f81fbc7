// A body with all that a cut asks of it, built once for any number of cuts.
#pragma once
#include <string>

#include "engine/fragment/piercing.h"

namespace sherd {

// A connected component of the surface.
struct BodyShell {
  std::uint32_t face = 0;   // one of its faces
  std::uint32_t faces = 0;  // their number
  Real volume = 0;          // m^3, negative for a cavity
};

class CutBody {
 public:
  // Vertices in no face are dropped. Never throws for a bad mesh: see defect().
  explicit CutBody(SurfaceMesh mesh);

  const SurfaceMesh& mesh() const { return operand_.mesh; }
  const std::vector<std::uint32_t>& twins() const { return operand_.twin; }
  const TriangleBvh& bvh() const { return operand_.bvh; }
  const CutOperand& operand() const { return operand_; }
  Real volume() const { return volume_; }        // m^3
  std::int64_t euler() const { return euler_; }  // of the surface: 2 for each shell, less 2 for each handle
  const std::vector<BodyShell>& shells() const { return shells_; }
  std::uint32_t shell_of(std::uint32_t face) const { return shell_[face]; }
  // Why no cut accepts the body; empty when all is well.
  const std::string& defect() const { return defect_; }

 private:
  CutBody(SurfaceMesh&& mesh, std::string defect);
  void label_shells();

  std::string defect_;
  CutOperand operand_;
  Real volume_ = 0;
  std::int64_t euler_ = 0;
  std::vector<std::uint32_t> shell_;  // per face
  std::vector<BodyShell> shells_;
};

}  // namespace sherd
