#include "engine/step/stats.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json step_json(const StepRecord& s) {
  Json j{{"step", s.step},
         {"time", s.time},
         {"bodies", s.bodies},
         {"asleep", s.asleep},
         {"triangles", s.triangles},
         {"pairs_near", s.pairs_near},
         {"contacts", s.contacts},
         {"parts", s.parts},
         {"contact_iterations", s.contact_iterations},
         {"contact_residual", s.contact_residual},
         {"contacts_unconverged", s.unconverged},
         {"recovery_work", s.recovery_work},
         {"fields_built", s.fields_built},
         {"solves", s.solves},
         {"solver_iterations", s.solver_iterations},
         {"cracks", s.cracks},
         {"new_bodies", s.fragments}};
  j["energy"] = {{"kinetic", s.energy.kinetic},
                 {"potential", s.energy.potential},
                 {"growth", s.energy_growth},
                 {"holds", s.energy_holds}};
  j["skipped"] = Json::object();
  for (const auto& [reason, count] : s.skipped) j["skipped"][reason] = count;
  j["seconds"] = {{"rigid", s.rigid_seconds}, {"fracture", s.fracture_seconds}};
  return j;
}

const char* cause_name(CrackCause cause) {
  switch (cause) {
    case CrackCause::kStress:
      return "stress";
    case CrackCause::kResumed:
      return "resumed";
    case CrackCause::kGuide:
      return "guide";
    case CrackCause::kInterior:
      return "interior";
  }
  return "";
}

Json sheet_json(const SheetQuality& q) {
  return {{"triangles", q.triangles},
          {"least_angle", q.least_angle},
          {"mean_angle", q.mean_angle},
          {"below_10_degrees", q.below_10},
          {"mean_radius_ratio", q.mean_radius_ratio},
          {"edge_ratio", q.edge_ratio}};
}

Json crack_json(const CrackRecord& c) {
  Json j{{"id", c.id},
         {"cause", cause_name(c.cause)},
         {"generation", c.generation},
         {"round", c.round},
         {"seed", vector_json(c.seed)},
         {"stress", c.stress},
         {"outcome", c.outcome},
         {"ladder_level", c.ladder_level},
         {"steps", c.steps},
         {"retreats", c.retreats},
         {"wings", c.wings},
         {"edge_length", c.edge_length},
         {"area", c.area},
         {"length", c.length},
         {"removed_volume", c.removed_volume},
         {"dust_volume", c.dust_volume},
         {"volume_error", c.volume_error},
         {"fragments", c.fragments}};
  if (c.sheet.triangles > 0) j["sheet"] = sheet_json(c.sheet);
  if (c.off_guide) j["off_guide"] = {{"rms", c.off_guide->rms}, {"largest", c.off_guide->largest}};
  if (c.net_section_stress != 0) j["net_section_stress"] = c.net_section_stress;
  if (!c.met.empty()) j["met"] = c.met;
  if (!c.reason.empty()) j["reason"] = c.reason;
  for (std::size_t k = 0; k < c.rungs.reason.size(); ++k)
    if (!c.rungs.reason[k].empty()) j["rungs"].push_back({{"level", k}, {"reason", c.rungs.reason[k]}});
  return j;
}

Json mesh_json(const MeshRecord& m) {
  return {{"body", m.body},
          {"body_id", m.body_id},
          {"step", m.step},
          {"triangles", m.triangles},
          {"resolution", Json::parse(to_json(m.resolution, *m.rule))},
          {"warnings", m.warnings}};
}

Json solve_json(const SolveRecord& r) {
  Json j{{"ok", r.solved},
         {"round", r.round},
         {"triangles", r.triangles},
         {"unknowns", r.unknowns},
         {"galerkin_vertices", r.galerkin_vertices},
         {"load_panels", r.panels},
         {"force", r.force},
         {"relief", r.relief},
         {"iterations", r.krylov.iterations},
         {"products", r.krylov.products},
         {"residual", r.krylov.residual},
         {"factored", r.factored},
         {"warm", r.warm},
         {"incompatibility", r.incompatibility},
         {"max_principal", r.strongest.stress.value},
         {"max_principal_at", vector_json(r.strongest.position)},
         {"seeds", r.seeds}};
  if (!r.reason.empty()) j["reason"] = r.reason;
  return j;
}

Json refit_json(const RefitReport& r) {
  Json j{{"ok", r.ok},
         {"strategy", r.strategy},
         {"attempts", r.attempts},
         {"min_angle", r.min_angle},
         {"volume_change", r.volume_change},
         {"wall_passes", r.wall_passes},
         {"thin_walls", r.thin_walls}};
  if (!r.reason.empty()) j["reason"] = r.reason;
  return j;
}

Json frame_json(const FrameRecord& f) {
  return {{"frame", f.index},
          {"time", f.time},
          {"bodies", f.certificates.size()},
          {"valid", f.valid},
          {"certificates", f.certificates},
          {"volume",
           {{"shown", f.volume},
            {"notches", f.notches},
            {"removed", f.removed},
            {"dust", f.dust},
            {"remeshing", f.remeshing},
            {"error", f.volume_error}}}};
}

Json certificate_json(const CertificateRecord& c) {
  Json j{{"body", c.body}, {"body_id", c.body_id}, {"mesh_version", c.mesh_version}};
  j.update(Json::parse(to_json(c.certificate)));
  return j;
}

Json event_json(const EventRecord& e) {
  const FractureResult& r = e.result;
  Json j{{"step", e.step}, {"time", e.time}, {"body", e.body}, {"body_id", e.body_id}};
  j["contacts"] = Json::array();
  for (const BodyContact& c : e.contacts)
    j["contacts"].push_back({{"point", vector_json(c.point)},
                             {"force", vector_json(c.force)},
                             {"duration", c.duration},
                             {"patch_radius", c.patch_radius}});
  j["applied_loads"] = e.applied_loads;
  if (!r.solves.empty()) j["solve"] = solve_json(r.solves[0]), j["solve"]["mesh"] = e.mesh;
  for (std::size_t k = 1; k < r.solves.size(); ++k) j["later_solves"].push_back(solve_json(r.solves[k]));
  j["cracks"] = Json::array();
  for (const CrackRecord& c : r.cracks) j["cracks"].push_back(crack_json(c));
  if (r.changed) {
    Real cracks = 0;
    for (const CrackRecord& c : r.cracks) cracks += c.removed_volume;
    j["new_bodies"] = e.new_bodies;
    j["volume"] = {{"before", r.volume_before},      {"removed", r.removed_volume},     {"cracks", cracks},
                   {"dust", r.dust_volume},          {"remeshing", r.remeshing_volume}, {"after", r.volume_after},
                   {"notches_shown", r.notch_volume}};
    j["refits"] = Json::array();
    for (const RefitReport& f : r.refits) j["refits"].push_back(refit_json(f));
    j["conservation"] = {{"mass", e.mass_error}, {"momentum", e.momentum_error}, {"angular_momentum", e.angular_error}};
  }
  const EventSeconds& s = r.seconds;
  j["seconds"] = {{"assemble", s.assemble}, {"solve", s.solve}, {"stress", s.stress}, {"front", s.front},
                  {"grow", s.grow},         {"cut", s.cut},     {"remesh", s.remesh}};
  return j;
}

Json totals_json(const RunRecord& r) {
  std::map<std::string, std::size_t> skipped, outcomes;
  std::size_t solves = 0, cracks = 0, fragments = 0, unconverged = 0;
  for (const StepRecord& s : r.steps) {
    unconverged += s.unconverged;
    solves += s.solves, cracks += s.cracks, fragments += s.fragments;
    for (const auto& [reason, count] : s.skipped) skipped[reason] += count;
  }
  for (const EventRecord& e : r.events)
    for (const CrackRecord& c : e.result.cracks) ++outcomes[c.outcome];
  Json j{{"steps", r.steps.empty() ? 0 : r.steps.back().step},
         {"solves", solves},
         {"cracks", cracks},
         {"new_bodies", fragments},
         {"contacts_unconverged", unconverged},
         {"bodies", r.steps.empty() ? 0 : r.steps.back().bodies}};
  j["crack_outcomes"] = outcomes;
  j["skipped"] = skipped;
  return j;
}

Json skips_json(const RunRecord& r) {
  Json j = Json::object();
  for (const SkipSwitch& s : kSkipSwitches)
    j[s.key] = {{"on", r.skip[s.skip]},
                {"counts", s.counts},
                {"done", r.skips[s.skip].done},
                {"skipped", r.skips[s.skip].skipped}};
  return j;
}

Json seconds_json(const RunRecord& r) {
  Real rigid = 0, fracture = 0;
  for (const StepRecord& s : r.steps) rigid += s.rigid_seconds, fracture += s.fracture_seconds;
  EventSeconds t;
  for (const EventRecord& e : r.events) {
    const EventSeconds& s = e.result.seconds;
    t.assemble += s.assemble, t.solve += s.solve, t.stress += s.stress, t.front += s.front, t.grow += s.grow,
        t.cut += s.cut, t.remesh += s.remesh;
  }
  return {{"prepare", r.prepare_seconds},
          {"rigid", rigid},
          {"fracture", fracture},
          {"assemble", t.assemble},
          {"solve", t.solve},
          {"stress", t.stress},
          {"front", t.front},
          {"grow", t.grow},
          {"cut", t.cut},
          {"remesh", t.remesh},
          {"certify", r.certify_seconds},
          {"threads", r.threads}};
}

}  // namespace

std::size_t RunRecord::certificate_of(std::uint32_t body_id, std::uint32_t mesh_version, const std::string& body,
                                      const SurfaceMesh& mesh) {
  const auto [at, fresh] = certified.try_emplace({body_id, mesh_version}, certificates.size());
  if (fresh) certificates.push_back({body_id, mesh_version, body, certify(mesh)});
  return at->second;
}

std::string digest_text(std::uint64_t sum) {
  return fmt::format("{:016x}", sum);
}

std::string to_json(const RunRecord& r, bool complete) {
  Json j;
  j["scene"] = r.scene, j["quality"] = r.quality;
  j["scene_digest"] = digest_text(r.scene_digest);
  j["complete"] = complete;
  j["messages"] = r.messages;
  if (r.field)
    j["field"] = {{"name", r.field->name}, {"unit", r.field->unit}, {"low", r.field->low}, {"high", r.field->high}};
  j["totals"] = totals_json(r);
  j["skips"] = skips_json(r);
  j["seconds"] = seconds_json(r);
  j["meshes"] = Json::array();
  for (const MeshRecord& m : r.meshes) j["meshes"].push_back(mesh_json(m));
  j["events"] = Json::array();
  for (const EventRecord& e : r.events) j["events"].push_back(event_json(e));
  j["certificates"] = Json::array();
  for (const CertificateRecord& c : r.certificates) j["certificates"].push_back(certificate_json(c));
  j["frames"] = Json::array();
  for (const FrameRecord& f : r.frames) j["frames"].push_back(frame_json(f));
  j["steps"] = Json::array();
  for (const StepRecord& s : r.steps) j["steps"].push_back(step_json(s));
  return j.dump(1) + "\n";
}

}  // namespace sherd
