// The run (paper algorithm 1): steps bodies, breaks them, says when a frame is due.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/frame/frame.h"
#include "engine/scene/scene.h"

namespace sherd {

struct SimulationOptions {
  int threads = 0;  // 0: all processors; the result does not depend on it
};

class Simulation {
 public:
  // Loads and prepares all bodies. Throws InputError when a mesh cannot be used.
  Simulation(const Scene& scene, const SimulationOptions& options);
  // Goes on from what state() gave for this scene, bit for bit as if it had not stopped. Throws ArchiveError when the
  // bytes do not fit, InputError when the bodies come out otherwise than when the run began.
  Simulation(const Scene& scene, const SimulationOptions& options, std::string_view state);
  ~Simulation();

  bool done() const;  // the scene's duration is reached
  void step();
  Real time() const;  // s
  std::size_t steps() const, bodies() const;
  // All that the run goes on from, between two steps: after snapshot() when a frame is due. Of this machine and build.
  std::string state();
  // True at the start and whenever simulated time has passed the next frame; snapshot() then serves it.
  bool frame_due() const;
  // Of the world, now; consumes the due frame and certifies every mesh it shows, for stats_json().
  Frame snapshot();
  // The scene's material_view body and its fragments in their material space, translucent; for the frame last served.
  Frame material_snapshot() const;
  View view() const;  // the scene's camera, or one that frames the bodies and where they fall
  View material_view() const;
  std::size_t frame_count() const;  // frames the whole run serves

  // What happened, as JSON. Everything under a key "seconds" may differ between runs; all else is the same in every
  // run.
  std::string stats_json() const;
  // What a person should know and has not taken yet, a line each: repairs of the meshes, then what breaks, what fails.
  std::vector<std::string> take_messages();
  // The same for what makes the results doubtful: scene bodies whose elements are too long for their walls.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
