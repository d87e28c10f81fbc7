#include "render/pieces.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/mesh/write.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {
namespace {

// Shepperd's method: divides by the largest of the four components. Nearest quaternion's sign to `last`.
std::array<Real, 4> to_quaternion(const Mat3& m, const std::array<Real, 4>& last) {
  const Real t = trace(m);
  std::array<Real, 4> q{};
  if (t >= m[0][0] && t >= m[1][1] && t >= m[2][2]) {
    q = {1 + t, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
  } else {
    const int i = m[0][0] >= m[1][1] ? (m[0][0] >= m[2][2] ? 0 : 2) : (m[1][1] >= m[2][2] ? 1 : 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto at = [](int axis) { return static_cast<std::size_t>(axis) + 1; };
    q[0] = m[k][j] - m[j][k];
    q[at(i)] = 1 + m[i][i] - m[j][j] - m[k][k];
    q[at(j)] = m[j][i] + m[i][j];
    q[at(k)] = m[k][i] + m[i][k];
  }
  Real length = 0, along = 0;
  for (std::size_t i = 0; i < 4; ++i) length += q[i] * q[i], along += q[i] * last[i];
  const Real scale = (along < 0 ? -1 : 1) / std::sqrt(length);
  for (Real& c : q) c *= scale;
  return q;
}

// Letters every file system takes, and not too many.
std::string file_name(const FrameBody& body) {
  std::string name = fmt::format("{:04}_v{}", body.id, body.mesh_version);
  if (!body.name.empty()) name += '_';
  for (const char c : body.name.substr(0, 64)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    name += plain ? c : '_';
  }
  return name + ".ply";
}

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

bool is_finite_pose(const FrameBody& b) {
  return is_finite(b.translation) && is_finite(b.rotation.row(0)) && is_finite(b.rotation.row(1)) &&
         is_finite(b.rotation.row(2));
}

}  // namespace

void remove_pieces(const std::filesystem::path& folder, const std::set<std::string>& kept) {
  std::error_code ignored;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    std::string name = entry.path().filename().string();
    if (name.ends_with(kPartSuffix)) name.resize(name.size() - kPartSuffix.size());
    if ((name.ends_with(".ply") || name == "transforms.json") && !kept.contains(entry.path().filename().string()))
      old.push_back(entry.path());
  }
  for (const auto& file : old) std::filesystem::remove(file, ignored);
}

PieceWriter::PieceWriter(std::filesystem::path folder, Real fps) : folder_(std::move(folder)), fps_(fps) {
  if (!(fps > 0) || !std::isfinite(fps))
    throw InputError("pieces: the frame rate must be positive; correct the scene's output rate");
  make_folder(folder_, "choose a writable output folder");
}

PieceWriter::~PieceWriter() {
  try {
    finish();
  } catch (...) {  // a destructor has nobody to tell; finish() called by hand reports
  }
}

void PieceWriter::write_shape(const Frame& frame, const FrameBody& body, Piece& piece) {
  const std::string path = (folder_ / file_name(body)).string();
  unflushed_.push_back(path);
  piece.field = body.field;
  if (!body.field) return write_ply(*body.mesh, path);
  SurfaceMesh mesh = *body.mesh;
  mesh.channels.push_back({frame.scale ? frame.scale->name : "field", 1, body.field->value});
  write_ply(mesh, path);
}

PieceWriter::Piece PieceWriter::start_piece(const Frame& frame, const FrameBody& body) {
  const std::string name = file_name(body);
  Piece piece;
  write_shape(frame, body, piece);
  piece.first_frame = frame.index;
  piece.file = name;
  piece.last_rotation = {1, 0, 0, 0};
  piece.head = fmt::format(R"({{"id": {}, "mesh_version": {}, "name": {}, "file": {}, "parent": {})", body.id,
                           body.mesh_version, json_string(body.name), json_string(name),
                           body.parent == kNone || body.parent == body.id ? "null" : std::to_string(body.parent));
  return piece;
}

void PieceWriter::add(const Frame& frame) {
  for (const FrameBody& body : frame.bodies)
    if (!body.mesh || !is_finite_pose(body))
      throw InputError(fmt::format("frame {}: body {} '{}' has no mesh or no finite pose; lower the time step",
                                   frame.index, body.id, body.name));
  for (const FrameBody& body : frame.bodies) {
    const std::pair key{body.id, body.mesh_version};
    auto found = pieces_.find(key);
    if (found == pieces_.end()) found = pieces_.emplace(key, start_piece(frame, body)).first;
    Piece& piece = found->second;
    if (piece.field != body.field) write_shape(frame, body, piece);
    piece.last_frame = frame.index;
    const auto q = piece.last_rotation = to_quaternion(body.rotation, piece.last_rotation);
    const Vec3& t = body.translation;
    piece.poses += fmt::format("{}[{}, {}, {}, {}, {}, {}, {}, {}]", piece.poses.empty() ? "" : ",\n  ", frame.index,
                               t.x, t.y, t.z, q[0], q[1], q[2], q[3]);
  }
  ++frames_;
  // Rewriting after each eighth more keeps all rewriting together within nine times the final size.
  if (frames_ - written_ >= std::clamp<std::size_t>(written_ / 8, 1, 64)) finish();
}

void PieceWriter::keep(Archive& a) {
  archive(a, frames_), archive(a, pieces_);
  if (!a.reading()) return;
  std::set<std::string> mine;
  for (const auto& [key, piece] : pieces_) {
    mine.insert(piece.file);
    std::error_code none;
    if (!std::filesystem::exists(folder_ / piece.file, none))
      throw InputError(fmt::format("{}: a piece of the run so far is gone; put it back, or start anew",
                                   (folder_ / piece.file).string()));
  }
  remove_pieces(folder_, mine);
}

void PieceWriter::flush() {
  unflushed_.push_back(folder_);
  flush_to_disk(unflushed_);
  unflushed_.clear();
}

void PieceWriter::finish() {
  if (written_ == frames_ && frames_ > 0) return;
  std::string text =
      fmt::format("{{\"units\": \"m\", \"up\": \"y\", \"fps\": {}, \"frames\": {}, \"pieces\": [", fps_, frames_);
  const char* separator = "\n ";
  for (const auto& [key, piece] : pieces_) {
    text += fmt::format("{}{}, \"first_frame\": {}, \"last_frame\": {}, \"poses\": [\n  {}]}}", separator, piece.head,
                        piece.first_frame, piece.last_frame, piece.poses);
    separator = ",\n ";
  }
  replace_file(folder_ / "transforms.json", text + "]}\n");
  written_ = frames_;
}

}  // namespace sherd
