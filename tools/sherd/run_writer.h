// The folder a run leaves: frames/, material/ when the scene asks for it, their movies, pieces/, stats.json.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/frame/frame.h"
#include "engine/scene/scene.h"
#include "render/pieces.h"
#include "render/rasterizer.h"

namespace sherd {

class RunWriter {
 public:
  // Creates the folder and takes an earlier run's results out of it, those only. With a state() it goes on from there:
  // results up to then stay, later ones go. InputError when that fails, when a file of that name is in the way, or when
  // a result of the run so far is gone.
  RunWriter(const SceneOutput& output, Real frame_rate, std::filesystem::path folder, bool render,
            std::string_view state = {});
  // What the next RunWriter on this folder goes on from; what is written so far is on the disk itself then.
  std::string state();
  // Draws and writes one frame; pictures are numbered in order of the calls, from 0.
  void add(const Frame& frame, const View& view);
  // The material-space picture of the frame last added. Call for every frame or for none.
  void add_material(const Frame& frame, const View& view);
  // Send every mesh to the renderer again for each picture (Skip::kUploads).
  void upload_always() { upload_always_ = true; }
  bool draws() const { return rasterizer_ != nullptr; }
  // Movies and statistics; returns a line for each result, and for each that is missing, why. InputError naming what
  // cannot be written.
  std::vector<std::string> finish(const std::string& stats_json);
  std::size_t frames() const { return frames_; }

 private:
  void keep(Archive& a);
  std::vector<std::filesystem::path> picture_folders() const;
  void add_movie(const std::string& pictures, const std::string& movie, std::vector<std::string>& results) const;

  SceneOutput output_;
  Real frame_rate_;
  std::filesystem::path folder_;
  std::unique_ptr<Rasterizer> rasterizer_, material_rasterizer_;  // null when nothing is drawn
  std::unique_ptr<PieceWriter> pieces_;                           // null when not wanted
  bool upload_always_ = false;
  std::size_t frames_ = 0, flushed_ = 0;  // written, brought to the disk itself
};

}  // namespace sherd
