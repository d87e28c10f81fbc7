// The pieces of a run for other programs: a folder with one PLY file a shape, and transforms.json with the pose of
// every shape in every frame. world = rotate(q, x) + t for a vertex x of the file.
//
//   {"units": "m", "up": "y", "fps": 60, "frames": 240, "pieces": [
//     {"id": 3, "mesh_version": 0, "name": "vase_1", "file": "0003_v0_vase_1.ply", "parent": 0,
//      "first_frame": 17, "last_frame": 239, "poses": [[17, tx, ty, tz, qw, qx, qy, qz], ...]}, ...]}
//
// A body with a field (frame.h) has it in its file as an attribute of corners, the field last shown.
//
// A shape is a body id with a mesh version: a body that only loses a splinter is followed by a new shape with its id.
// "parent" is the body id it broke off, null for a body of the scene. Frames are the frames' own indices.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "engine/frame/frame.h"
#include "kernels/core/archive.h"

namespace sherd {

// Removes what a PieceWriter, also one that was killed, left in its folder, but for the PLY files named in `kept`.
void remove_pieces(const std::filesystem::path& folder, const std::set<std::string>& kept = {});

class PieceWriter {
 public:
  // Creates `folder` (and its parents); throws InputError naming it when that fails, or when fps is not positive.
  PieceWriter(std::filesystem::path folder, Real fps);
  // Calls finish(), silently.
  ~PieceWriter();
  PieceWriter(const PieceWriter&) = delete;
  PieceWriter& operator=(const PieceWriter&) = delete;

  // Writes the PLY files of new shapes at once and keeps the poses. transforms.json is rewritten as the run grows, at
  // least every 64 frames or after each eighth more: the file on disk is valid at any time. Throws InputError naming
  // the file that cannot be written, or the body whose pose is not finite.
  void add(const Frame& frame);
  // Poses and names of all shapes so far, written or read; the PLY files stay where they are. Reading is for a writer
  // fresh from its constructor. Throws InputError naming a file of these that is no longer there, and removes PLY files
  // of others: of frames after the state was taken.
  void keep(Archive& a);
  // Brings the PLY files to the disk itself.
  void flush();
  // Brings transforms.json up to the last frame added.
  void finish();

 private:
  struct Piece {
    std::string head;  // of the JSON object, up to the frame numbers
    std::size_t first_frame = 0, last_frame = 0;
    std::array<Real, 4> last_rotation{};        // w x y z, for signs that do not jump
    std::string poses;                          // JSON, comma separated
    std::string file;                           // name in the folder
    std::shared_ptr<const SurfaceField> field;  // in the file
  };
  Piece start_piece(const Frame& frame, const FrameBody& body);
  void write_shape(const Frame& frame, const FrameBody& body, Piece& piece);

  std::filesystem::path folder_;
  Real fps_;
  std::size_t frames_ = 0, written_ = 0;  // added, in transforms.json
  std::vector<std::filesystem::path> unflushed_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Piece> pieces_;  // (body id, mesh version)
};

}  // namespace sherd
