#include "tools/sherd/run_writer.h"

#include <charconv>
#include <optional>

#include "engine/step/checkpoint.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"
#include "kernels/core/trace.h"
#include "render/movie.h"
#include "render/png.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrames = "frames";
constexpr const char* kMaterial = "material";
constexpr const char* kPieces = "pieces";
constexpr const char* kStatistics = "stats.json";
constexpr const char* kMovie = "movie.mp4";
constexpr const char* kMaterialMovie = "material.mp4";
constexpr const char* kPattern = "frame_%04d.png";  // what picture_name() gives, as ffmpeg reads it

std::string picture_name(std::size_t number) {
  return fmt::format("frame_{:04}.png", number);
}

constexpr const char* kRemedy = "choose another folder with --out";

// The number of a picture's file, also of one that a killed run left half-written; nothing for other files.
std::optional<std::size_t> picture_number(std::string name) {
  if (name.ends_with(kPartSuffix)) name.resize(name.size() - kPartSuffix.size());
  std::size_t number = 0;
  const char* end = name.data() + name.size();
  if (!name.starts_with("frame_") || !name.ends_with(".png")) return std::nullopt;
  const auto [last, error] = std::from_chars(name.data() + 6, end, number);
  return error == std::errc{} && last == end - 4 ? std::optional(number) : std::nullopt;
}

// Of an earlier or killed run, from picture `first` on.
void remove_pictures(const fs::path& folder, std::size_t first) {
  std::error_code ignored;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (const auto number = picture_number(name); number && (*number >= first || name.ends_with(kPartSuffix)))
      old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file, ignored);
}

void require_pictures(const fs::path& folder, std::size_t count) {
  std::error_code none;
  for (std::size_t i = 0; i < count; ++i)
    if (const fs::path file = folder / picture_name(i); !fs::exists(file, none))
      throw InputError(fmt::format(
          "{}: a picture of the run so far is gone; put it back, or start anew, without --resume", file.string()));
}

// What stands for a whole run and would not be true before the end of the next one.
void remove_summaries(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {kStatistics, kMovie, kMaterialMovie}) {
    fs::remove(folder / name, ignored);
    fs::remove((folder / name).string() + std::string(kPartSuffix), ignored);
  }
}

void draw(Rasterizer& rasterizer, const Frame& frame, const View& view, const fs::path& file) {
  Image image;
  {
    const TraceScope scope("render");
    image = rasterizer.render(frame, view);
  }
  const TraceScope scope("write picture");
  write_png(file, image);
}

}  // namespace

RunWriter::RunWriter(const SceneOutput& output, Real frame_rate, fs::path folder, bool render, std::string_view state)
    : output_(output), frame_rate_(frame_rate), folder_(std::move(folder)) {
  make_folder(folder_, kRemedy);
  remove_summaries(folder_);
  // Pictures and pieces of an earlier, longer run would mix with the new ones. The folder pieces/ is known as ours by
  // its transforms.json.
  std::error_code none;
  if (state.empty()) {
    remove_checkpoints(folder_);
    for (const char* pictures : {kFrames, kMaterial}) remove_pictures(folder_ / pictures, 0);
    if (fs::exists(folder_ / kPieces / "transforms.json", none)) remove_pieces(folder_ / kPieces);
  }
  if (render && output_.frames) {
    make_folder(folder_ / kFrames, kRemedy);
    rasterizer_ = std::make_unique<Rasterizer>();
  }
  if (rasterizer_ && output_.material_view) {
    make_folder(folder_ / kMaterial, kRemedy);
    material_rasterizer_ = std::make_unique<Rasterizer>();
  }
  if (output_.pieces) pieces_ = std::make_unique<PieceWriter>(folder_ / kPieces, frame_rate_);
  if (state.empty()) return;
  Archive a(state);
  keep(a);
  a.finish();
  for (const fs::path& pictures : picture_folders()) {
    require_pictures(pictures, frames_);
    remove_pictures(pictures, frames_);
  }
}

std::vector<fs::path> RunWriter::picture_folders() const {
  std::vector<fs::path> folders;
  if (rasterizer_) folders.push_back(folder_ / kFrames);
  if (material_rasterizer_) folders.push_back(folder_ / kMaterial);
  return folders;
}

void RunWriter::keep(Archive& a) {
  archive(a, frames_);
  if (pieces_) pieces_->keep(a);
}

std::string RunWriter::state() {
  std::vector<fs::path> files = picture_folders();
  for (const fs::path& pictures : picture_folders())
    for (std::size_t i = flushed_; i < frames_; ++i) files.push_back(pictures / picture_name(i));
  flush_to_disk(files);
  flushed_ = frames_;
  if (pieces_) pieces_->flush();
  Archive a;
  keep(a);
  return a.take();
}

void RunWriter::add(const Frame& frame, const View& view) {
  if (rasterizer_ && upload_always_) rasterizer_->forget_meshes();
  if (rasterizer_) draw(*rasterizer_, frame, view, folder_ / kFrames / picture_name(frames_));
  if (pieces_) {
    const TraceScope scope("write pieces");
    pieces_->add(frame);
  }
  ++frames_;
}

void RunWriter::add_material(const Frame& frame, const View& view) {
  if (material_rasterizer_ && upload_always_) material_rasterizer_->forget_meshes();
  if (material_rasterizer_) draw(*material_rasterizer_, frame, view, folder_ / kMaterial / picture_name(frames_ - 1));
}

void RunWriter::add_movie(const std::string& pictures, const std::string& movie,
                          std::vector<std::string>& results) const {
  results.push_back(fmt::format("frames:     {} ({} pictures)", (folder_ / pictures).string(), frames_));
  if (!output_.movie) return;
  const TraceScope scope("movie");
  const MovieResult made = encode_movie(folder_ / pictures, kPattern, 0, frame_rate_, folder_ / movie);
  if (made.failed) throw InputError(made.reason);
  results.push_back(made.made ? fmt::format("movie:      {}", (folder_ / movie).string())
                              : fmt::format("movie:      not made: {}", made.reason));
}

std::vector<std::string> RunWriter::finish(const std::string& stats_json) {
  std::vector<std::string> results;
  replace_file(folder_ / kStatistics, stats_json);
  results.push_back(fmt::format("statistics: {}", (folder_ / kStatistics).string()));
  if (pieces_) {
    pieces_->finish();
    results.push_back(fmt::format("pieces:     {}", (folder_ / kPieces).string()));
  }
  if (rasterizer_ && frames_ > 0) add_movie(kFrames, kMovie, results);
  if (material_rasterizer_ && frames_ > 0) add_movie(kMaterial, kMaterialMovie, results);
  return results;
}

}  // namespace sherd
