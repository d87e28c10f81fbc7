// A body broken again and again: all pieces of a generation crack, and are remeshed for the next (the design's T2).
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/campaign/specimen.h"

namespace sherd::campaign {

struct GenerationOptions {
  int least_generations = 3, most_generations = 6;
  std::size_t least_pieces = 64;    // generations go on until there are so many
  int cracks_per_piece = 3;         // each in the largest part so far, without remeshing in between
  Real min_fragment_volume = 1e-4;  // of the body's volume; smaller is dust
  Real thickness = 1e-3;            // of the body's diagonal
  Real edge_per_thickness = 0;      // of the remeshing; 0: one edge length a piece
  bool solve = true;                // every last piece by the stress stage
  std::uint64_t seed = 1;
};

struct GenerationRow {
  int generation = 0;
  std::size_t pieces = 0, cracks = 0, true_field = 0, dropped = 0, unbroken = 0;  // unbroken: pieces without a crack
  std::size_t invalid = 0;                                                        // cracks with a broken law
  std::size_t refit_refused = 0;  // pieces that kept the mesh of the cut
  std::size_t graded = 0;         // pieces with shorter edges at thin walls
  std::size_t certified = 0, below_1_degree = 0, below_15_degrees = 0, triangles = 0;
  Real min_angle = 0;            // degrees
  Real refit_volume_change = 0;  // sum of absolute changes, of the body's volume
};

struct GenerationResult {
  std::string shape;
  std::vector<GenerationRow> rows;
  std::vector<SurfaceMesh> pieces;       // of the last generation
  std::size_t solvable = 0, warned = 0;  // of them; solvable: solved without a warning
  Real dust_volume = 0;                  // of the body's volume
  Real volume_error = 0;                 // |V - pieces - thickness x crack area - dust| / V
  Real removed_error = 0;                // |removed volume - thickness x crack area| / removed volume
  std::vector<std::string> warnings;     // distinct first words of the stress stage's warnings, and broken laws
  Real seconds = 0;
};

GenerationResult run_generations(const Specimen& body, const GenerationOptions& options);

std::string generation_header();
std::string to_text(const GenerationResult& result);  // a row a generation, and a line of sums
nlohmann::json to_json(const GenerationResult& result);

}  // namespace sherd::campaign
