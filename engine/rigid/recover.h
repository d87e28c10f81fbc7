// Pushing bodies out of penetration by displacement alone.
#pragma once
#include "engine/rigid/part.h"

namespace sherd {

// `gaps`: signed distance of each row at the end of the part (m), by its velocities. Removes a share of what lies
// beyond the slop, at a bounded speed, closing no gap further than to zero; velocities stay, but for the turn of each
// group of free bodies that keeps its angular momentum. Returns the change of the energy, J.
Real recover(StepWorld& world, std::span<const Contact> contacts, std::span<const ContactRow> rows,
             std::span<const Real> gaps, Real time);

}  // namespace sherd
