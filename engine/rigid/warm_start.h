// Impulses of the last push, from which the next solve starts.
#pragma once
#include "engine/rigid/part.h"

namespace sherd {

// Starts each row from the impulse of the nearest contact of the pair in the last push, each used once; `time` is the
// part's length (s).
void warm_start(const StepWorld& world, std::span<const Contact> contacts, Real time, std::span<ContactRow> rows);
void keep_warm(StepWorld& world, std::span<const Contact> contacts, Real time, std::span<const ContactRow> rows);

}  // namespace sherd
