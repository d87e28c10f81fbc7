#include "tools/sherd/run_writer.h"

#include <fstream>

#include "kernels/core/error.h"
#include "kernels/core/trace.h"
#include "render/movie.h"
#include "render/png.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrames = "frames";
constexpr const char* kMaterial = "material";
constexpr const char* kPattern = "frame_%04d.png";  // what picture_name() gives, as ffmpeg reads it

std::string picture_name(std::size_t number) {
  return fmt::format("frame_{:04}.png", number);
}

// Pictures and pieces of an earlier, longer run would mix with the new ones.
void remove_earlier_results(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> old{folder / "movie.mp4", folder / "material.mp4", folder / "stats.json"};
  for (const char* pictures : {kFrames, kMaterial})
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / pictures, error)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("frame_") && name.ends_with(".png")) old.push_back(entry.path());
    }
  // The folder pieces/ is known as ours by its transforms.json.
  if (fs::exists(folder / "pieces" / "transforms.json", error)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "pieces", error))
      if (entry.path().extension() == ".ply") old.push_back(entry.path());
    old.push_back(folder / "pieces" / "transforms.json");
  }
  for (const fs::path& file : old) fs::remove(file, error);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(fmt::format("{}: cannot create this folder ({}); choose another with --out", folder.string(),
                                 error ? error.message() : "a file is in the way"));
}

void write_text(const fs::path& file, const std::string& text) {
  const fs::path temporary = file.string() + ".part";
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.flush();
    if (!stream) throw InputError(fmt::format("{}: cannot be written; is the disk full?", file.string()));
  }
  fs::rename(temporary, file);
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

RunWriter::RunWriter(const SceneOutput& output, Real frame_rate, fs::path folder, bool render)
    : output_(output), frame_rate_(frame_rate), folder_(std::move(folder)) {
  make_folder(folder_);
  remove_earlier_results(folder_);
  if (render && output_.frames) {
    make_folder(folder_ / kFrames);
    rasterizer_ = std::make_unique<Rasterizer>();
  }
  if (rasterizer_ && output_.material_view) {
    make_folder(folder_ / kMaterial);
    material_rasterizer_ = std::make_unique<Rasterizer>();
  }
  if (output_.pieces) pieces_ = std::make_unique<PieceWriter>(folder_ / "pieces", frame_rate_);
}

void RunWriter::add(const Frame& frame, const View& view) {
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
  results.push_back(made.made ? fmt::format("movie:      {}", (folder_ / movie).string())
                              : fmt::format("movie:      not made: {}", made.reason));
}

std::vector<std::string> RunWriter::finish(const std::string& stats_json) {
  std::vector<std::string> results;
  write_text(folder_ / "stats.json", stats_json);
  results.push_back(fmt::format("statistics: {}", (folder_ / "stats.json").string()));
  if (pieces_) {
    pieces_->finish();
    results.push_back(fmt::format("pieces:     {}", (folder_ / "pieces").string()));
  }
  if (rasterizer_ && frames_ > 0) add_movie(kFrames, "movie.mp4", results);
  if (material_rasterizer_ && frames_ > 0) add_movie(kMaterial, "material.mp4", results);
  return results;
}

}  // namespace sherd
