// The crack campaign as a benchmark: shares of cracks that follow the true field, and what went wrong where.
#pragma once
#include <string>
#include <vector>

#include "tools/campaign/campaign.h"

namespace sherd::bench {

struct CracksOptions {
  std::vector<std::string> shapes;  // empty: all
  campaign::CampaignOptions campaign;
  std::string meshes = "../shared/meshes/dev";  // folder of the statues
  bool timing = false;                          // how long one crack takes instead
  bool log = false;                             // a line for each job that left the true field
  bool generations = false;                     // break bodies again and again instead
  double edge_per_thickness = 0;
  std::string pieces;  // folder for the last pieces as PLY files
  std::string json;
};
// Prints a table; 0, or 1 when a result was invalid, a body changed or a job hung.
int run_cracks(const CracksOptions& options);

// One thread: a crack of 500 triangles in a body of 20,000 faces, and the same cut in bodies of 5,000 to 320,000 faces.
int run_crack_timing(const std::string& json);

}  // namespace sherd::bench
