// Shorter edges where a cut left walls too thin for them. Internal to refit().
#pragma once
#include "engine/mesh/refit.h"

namespace sherd {

// Grades `mesh`, of which `report` tells, and says so in the report; what breaks a promise of the options is not taken.
// `volume`: of the piece as it was cut, m^3.
void refit_walls(SurfaceMesh& mesh, const RefitOptions& options, Real volume, RefitReport& report);

}  // namespace sherd
