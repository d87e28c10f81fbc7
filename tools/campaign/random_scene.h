// Random scenes, to find what breaks the simulation instead of the bodies.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sherd::campaign {

// A scene file's text: one to four generated bodies of 1 mm to 100 m, stiffness and strength over six decades each,
// speeds to 100 m/s, spins, time steps of 1e-4 to 1e-2 s, stacked, thrown at each other or in flight, some fixed, held
// by loads, guided or notched. The same text for the same seed. `duration` in s.
std::string random_scene(std::uint64_t seed, double duration);

// What a run's statistics (stats.json) must hold whatever the scene: every number finite, every frame's meshes
// certified and their volumes accounted for, mass and momenta kept by fracture, no step that adds energy. A line each.
std::vector<std::string> broken_laws(const nlohmann::json& stats);

}  // namespace sherd::campaign
