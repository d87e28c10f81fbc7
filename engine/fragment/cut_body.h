// A body with all that a cut asks of it, built once for any number of cuts.
#pragma once
#include <string>

#include "engine/fragment/piercing.h"

namespace sherd {

class CutBody {
 public:
  // Never throws for a bad mesh: see defect().
  explicit CutBody(SurfaceMesh mesh);

  const SurfaceMesh& mesh() const { return operand_.mesh; }
  const std::vector<std::uint32_t>& twins() const { return operand_.twin; }
  const TriangleBvh& bvh() const { return operand_.bvh; }
  const CutOperand& operand() const { return operand_; }
  Real volume() const { return volume_; }        // m^3
  std::int64_t euler() const { return euler_; }  // of the surface: 2 for each shell, less 2 for each handle
  // Why no cut accepts the body; empty when all is well.
  const std::string& defect() const { return defect_; }

 private:
  CutBody(SurfaceMesh&& mesh, std::string defect);

  std::string defect_;
  CutOperand operand_;
  Real volume_ = 0;
  std::int64_t euler_ = 0;
};

}  // namespace sherd
