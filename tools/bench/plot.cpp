#include "tools/bench/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "kernels/core/error.h"

namespace sherd::bench {
namespace {

constexpr double kWidth = 640, kHeight = 440, kLeft = 70, kRight = 20, kTop = 40, kBottom = 55;
constexpr std::array<const char*, 6> kColours = {"#1f5fa8", "#c0392b", "#2e8b57", "#8e44ad", "#b9770e", "#34495e"};

bool usable(Real x, Real y) {
  return x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y);
}

// One logarithmic axis in pixels.
struct Axis {
  double low = 1e300, high = 0, from = 0, to = 0;
  void grow(double v) { low = std::min(low, v), high = std::max(high, v); }
  void finish() {
    if (high <= 0) low = 0.1, high = 10;
    low /= 1.3, high *= 1.3;
  }
  double at(double v) const { return from + (to - from) * std::log(v / low) / std::log(high / low); }
  // Values 1, 2 and 5 times powers of ten within the axis, over more than six decades every second power alone; with
  // few of them all get a label.
  std::vector<double> ticks() const {
    std::vector<double> t;
    const bool wide = high > 1e6 * low;
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= static_cast<int>(std::log10(high)) + 1; ++e)
      for (const double m : {1.0, 2.0, 5.0})
        if (const double v = m * std::pow(10, e); v >= low && v <= high && !(wide && (m > 1 || e % 2 != 0)))
          t.push_back(v);
    return t;
  }
};

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string text(double x, double y, const char* anchor, const std::string& s, int size = 12) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>\n", x, y, anchor,
                     size, escaped(s));
}

std::string line(double x1, double y1, double x2, double y2, const char* stroke) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                     stroke);
}

std::string axes(const Axis& x, const Axis& y, const LogLogPlot& plot) {
  std::string s;
  const bool all_x = x.ticks().size() <= 9, all_y = y.ticks().size() <= 12;
  const auto decade = [](double v) { return std::abs(std::log10(v) - std::round(std::log10(v))) < 1e-6; };
  for (const double v : x.ticks()) {
    s += line(x.at(v), y.from, x.at(v), y.to, decade(v) ? "#bbb" : "#e6e6e6");
    if (all_x || decade(v)) s += text(x.at(v), y.from + 18, "middle", fmt::format("{:g}", v));
  }
  for (const double v : y.ticks()) {
    s += line(x.from, y.at(v), x.to, y.at(v), decade(v) ? "#bbb" : "#e6e6e6");
    if (all_y || decade(v)) s += text(x.from - 6, y.at(v) + 4, "end", fmt::format("{:g}", v));
  }
  s += line(x.from, y.from, x.to, y.from, "#000") + line(x.from, y.from, x.from, y.to, "#000");
  s += text(0.5 * (x.from + x.to), kHeight - 15, "middle", plot.x_label);
  s += fmt::format(
      "<text transform=\"translate(18 {:.1f}) rotate(-90)\" text-anchor=\"middle\" font-size=\"12\">{}</text>\n",
      0.5 * (y.from + y.to), escaped(plot.y_label));
  return s + text(0.5 * kWidth, 22, "middle", plot.title, 14);
}

std::string curve(const Series& series, const Axis& x, const Axis& y, const char* colour) {
  std::string path, marks;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!usable(series.x[i], series.y[i])) continue;
    const double px = x.at(series.x[i]), py = y.at(series.y[i]);
    path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", px, py);
    marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", px, py, colour);
    if (i < series.label.size()) marks += text(px + 6, py - 6, "start", series.label[i], 10);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n", path, colour) + marks;
}

}  // namespace

std::string to_svg(const LogLogPlot& plot) {
  Axis x, y;
  for (const Series& s : plot.series)
    for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i)
      if (usable(s.x[i], s.y[i])) x.grow(s.x[i]), y.grow(s.y[i]);
  x.finish(), y.finish();
  x.from = kLeft, x.to = kWidth - kRight, y.from = kHeight - kBottom, y.to = kTop;
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      kWidth, kHeight);
  s += axes(x, y, plot);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const char* colour = kColours[i % kColours.size()];
    s += curve(plot.series[i], x, y, colour);
    const double row = kTop + 16 + 18 * static_cast<double>(i), column = kWidth - kRight - 150;
    s += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" height=\"4\" fill=\"{}\"/>\n", column, row - 6,
                     colour);
    s += text(column + 20, row, "start", plot.series[i].name);
  }
  return s + "</svg>\n";
}

void write_svg(const LogLogPlot& plot, const std::string& path) {
  std::ofstream file(path);
  file << to_svg(plot);
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written; choose a folder that exists and is writable", path));
}

}  // namespace sherd::bench
