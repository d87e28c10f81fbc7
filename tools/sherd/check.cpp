#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/mesh/load.h"
#include "engine/mesh/repair.h"
#include "engine/mesh/thickness_resolution.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "tools/sherd/commands.h"

namespace sherd {
namespace {

struct CheckResult {
  MeshReport loaded, repaired;
  std::vector<std::string> load_messages, repair_messages;
  ResolutionReport resolution;  // of the mesh as usable
  std::string refusal;          // empty when the mesh is or became valid
};

CheckResult check(const CheckOptions& options) {
  CheckResult result;
  const std::string name = options.mesh.string();
  LoadLog log;
  SurfaceMesh mesh = load_mesh(name, {}, log);
  result.load_messages = log.messages;
  const ReportOptions count{.count_self_intersections = true};
  result.loaded = report_mesh(mesh, count);
  try {
    repair_mesh(mesh, {.name = name, .max_hole_diameter = options.max_hole}, result.repair_messages);
    result.repaired = report_mesh(mesh, count);
    result.resolution = resolution_report(mesh);
  } catch (const InputError& error) {
    result.refusal = error.what();
  }
  return result;
}

void print_messages(const char* title, const std::vector<std::string>& messages) {
  if (messages.empty()) return;
  std::printf("\n%s\n", title);
  for (const std::string& message : messages) std::printf("  %s\n", message.c_str());
}

void print_text(const std::string& name, const CheckResult& r) {
  std::printf("%s, as read:\n%s", name.c_str(), to_text(r.loaded).c_str());
  print_messages("Reading changed:", r.load_messages);
  print_messages("Repair changed:", r.repair_messages);
  if (!r.refusal.empty())
    std::printf("\nNot usable: %s\n", r.refusal.c_str());
  else if (r.repair_messages.empty())
    std::printf("\nUsable as it is.\n");
  else
    std::printf("\nAfter repair:\n%s\nUsable after repair.\n", to_text(r.repaired).c_str());
  if (!r.refusal.empty()) return;
  std::printf("\nWall thickness and resolution:\n%s", to_text(r.resolution).c_str());
  print_messages("Warnings:", resolution_warnings(r.resolution));
}

void print_json(const std::string& name, const CheckResult& r) {
  const bool usable = r.refusal.empty();
  nlohmann::ordered_json out;
  out["file"] = name;
  out["usable"] = usable;
  out["loaded"] = nlohmann::ordered_json::parse(to_json(r.loaded));
  out["load_messages"] = r.load_messages;
  out["repair_messages"] = r.repair_messages;
  if (usable) {
    out["repaired"] = nlohmann::ordered_json::parse(to_json(r.repaired));
    out["resolution"] = nlohmann::ordered_json::parse(to_json(r.resolution));
    out["warnings"] = resolution_warnings(r.resolution);
  } else {
    out["refusal"] = r.refusal;
  }
  // File names need not be UTF-8; JSON has to be.
  std::printf("%s\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

}  // namespace

int check_command(const CheckOptions& options) {
  const CheckResult result = check(options);
  if (options.json)
    print_json(options.mesh.string(), result);
  else
    print_text(options.mesh.string(), result);
  return result.refusal.empty() ? kSuccess : kBadInput;
}

}  // namespace sherd
