// A log-log line plot as an SVG file, readable without any tool but a browser.
#pragma once
#include <string>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd::bench {

struct Series {
  std::string name;
  std::vector<Real> x, y;            // positive
  std::vector<std::string> label{};  // one a point, or none
};
struct LogLogPlot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};
// Axes with decades, minor ticks at 2 and 5, a legend. Points that are not positive and finite are left out.
std::string to_svg(const LogLogPlot& plot);
// InputError when the file cannot be written.
void write_svg(const LogLogPlot& plot, const std::string& path);

}  // namespace sherd::bench
