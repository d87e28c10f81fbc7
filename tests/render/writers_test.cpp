#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/mesh/load.h"
#include "kernels/core/error.h"
#include "kernels/core/random.h"
#include "render/movie.h"
#include "render/pieces.h"
#include "render/png.h"
#include "tests/render/picture.h"

namespace sherd {
namespace {

Image noise(int width, int height) {
  Image image{width, height, {}};
  Random random(7);
  for (int i = 0; i < 3 * width * height; ++i) image.rgb.push_back(static_cast<std::uint8_t>(random.next() & 255));
  return image;
}

template <class F>
std::string refusal(const F& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

nlohmann::json read_transforms(const std::filesystem::path& folder) {
  std::ifstream in(folder / "transforms.json");
  return nlohmann::json::parse(in);
}

TEST(Png, APictureReadsBackAsWritten) {
  const TemporaryFolder folder;
  const Image image = noise(37, 21);
  write_png(folder.path() / "a.png", image);
  EXPECT_EQ(image, read_png(folder.path() / "a.png"));
}

TEST(Png, ABrokenFileIsAnErrorWithItsName) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "broken.png";
  write_png(path, noise(64, 64));
  std::filesystem::resize_file(path, 500);
  EXPECT_NE(refusal([&] { read_png(path); }).find(path.string()), std::string::npos);
  EXPECT_NE(refusal([&] { read_png(folder.path() / "none.png"); }).find("none.png"), std::string::npos);
}

TEST(Png, AnUnwritablePlaceIsAnErrorWithTheFilesName) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "frame_00003.png";
  EXPECT_NE(refusal([&] { write_png(path, noise(4, 4)); }).find(path.string()), std::string::npos);
}

TEST(Png, AnImageWithTooFewBytesIsRefused) {
  const TemporaryFolder folder;
  Image image = noise(4, 4);
  image.rgb.pop_back();
  EXPECT_FALSE(refusal([&] { write_png(folder.path() / "a.png", image); }).empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Restores PATH.
class WithPath {
 public:
  explicit WithPath(const std::string& path) : old_(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
  ~WithPath() { setenv("PATH", old_.c_str(), 1); }
  WithPath(const WithPath&) = delete;
  WithPath& operator=(const WithPath&) = delete;

 private:
  std::string old_;
};

TEST(Movie, WithoutFfmpegTheReasonNamesIt) {
  const TemporaryFolder folder;
  const WithPath path(folder.path().string());
  const MovieResult result = encode_movie(folder.path(), "frame_%05d.png", 0, 30, folder.path() / "movie.mp4");
  EXPECT_FALSE(result.made);
  EXPECT_NE(result.reason.find("ffmpeg is not on PATH"), std::string::npos) << result.reason;
}

// A program by the name of ffmpeg that leaves its last argument (file:PATH) behind and succeeds only for MPEG-4.
TEST(Movie, FallsBackToTheSecondEncoderAndRenames) {
  const TemporaryFolder folder;
  {
    std::ofstream script(folder.path() / "ffmpeg");
    script << "#!/bin/sh\ncase \"$*\" in *libx264*) echo 'Unknown encoder' >&2; exit 1;; esac\n"
           << "for last; do :; done\necho movie > \"${last#file:}\"\n";
  }
  std::filesystem::permissions(folder.path() / "ffmpeg", std::filesystem::perms::owner_all);
  const WithPath path(folder.path().string());
  const auto movie = folder.path() / "a movie; $(x).mp4";
  const MovieResult result = encode_movie(folder.path(), "frame_%05d.png", 0, 30, movie);
  EXPECT_TRUE(result.made) << result.reason;
  EXPECT_EQ(result.encoder, "mpeg4");
  EXPECT_TRUE(std::filesystem::exists(movie));
  EXPECT_FALSE(std::filesystem::exists(movie.string() + ".part"));
}

TEST(Movie, ARealFfmpegMakesAMovieOfAnOddSizeInAnOddFolder) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
  const TemporaryFolder folder;
  const auto frames = folder.path() / "100%d frames";
  std::filesystem::create_directories(frames);
  for (const int i : {3, 4, 5}) write_png(frames / fmt::format("frame_{:05}.png", i), noise(65, 33));
  const MovieResult result = encode_movie(frames, "frame_%05d.png", 3, 30, folder.path() / "movie.mp4");
  EXPECT_TRUE(result.made) << result.reason;
  ASSERT_TRUE(std::filesystem::exists(folder.path() / "movie.mp4"));
  EXPECT_GT(std::filesystem::file_size(folder.path() / "movie.mp4"), 500u);
  const MovieResult none = encode_movie(folder.path() / "empty", "frame_%05d.png", 0, 30, folder.path() / "none.mp4");
  EXPECT_FALSE(none.made);
  EXPECT_NE(none.reason.find("none.mp4"), std::string::npos) << none.reason;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "none.mp4"));
}

// z by angle a: the textbook rotation.
Mat3 about_z(Real a) {
  Mat3 m = Mat3::identity();
  m[0][0] = m[1][1] = std::cos(a), m[0][1] = -std::sin(a), m[1][0] = std::sin(a);
  return m;
}

TEST(Pieces, EveryFrameLeavesValidJsonAndPosesRebuildTheRotation) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "run" / "pieces";
  PieceWriter writer(out, 24);
  FrameBody body = body_of(make_box({1, 1, 1}, 0.5), 4);
  body.name = "vase \"A\"/\n\xff";
  for (std::size_t i = 0; i < 40; ++i) {
    Frame frame;
    frame.index = i;
    body.rotation = about_z(0.25 * static_cast<Real>(i));  // past a half turn and a full one: every branch, sign jumps
    body.translation = {0.1 * static_cast<Real>(i), 1, -2};
    frame.bodies = {body};
    writer.add(frame);
    EXPECT_LE(read_transforms(out)["frames"].get<std::size_t>(), i + 1);
    EXPECT_GE(8 * (i + 1), 7 * read_transforms(out)["frames"].get<std::size_t>());
  }
  writer.finish();
  const auto json = read_transforms(out);
  ASSERT_EQ(json["pieces"].size(), 1u);
  const auto& piece = json["pieces"][0];
  EXPECT_TRUE(std::filesystem::exists(out / piece["file"].get<std::string>()));
  EXPECT_EQ(piece["last_frame"], 39);
  EXPECT_TRUE(piece["parent"].is_null());
  ASSERT_EQ(piece["poses"].size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    const auto pose = piece["poses"][i].get<std::vector<double>>();
    const double half = 0.125 * static_cast<double>(i);  // continuous in sign from the identity
    EXPECT_NEAR(pose[4], std::cos(half), 1e-14);
    EXPECT_NEAR(pose[7], std::sin(half), 1e-14);
    EXPECT_DOUBLE_EQ(pose[1], 0.1 * static_cast<double>(i));
  }
}

TEST(Pieces, ANewShapeIsANewPieceWithItsParent) {
  const TemporaryFolder folder;
  {
    PieceWriter writer(folder.path(), 30);
    Frame frame;
    frame.bodies = {body_of(make_box({1, 1, 1}, 0.5), 0)};
    writer.add(frame);
    frame.index = 1;
    frame.bodies = {body_of(make_box({0.5, 1, 1}, 0.5), 1), body_of(make_box({0.4, 1, 1}, 0.5), 2)};
    frame.bodies[0].parent = frame.bodies[1].parent = 0;
    writer.add(frame);
    frame.index = 2;
    frame.bodies[1].mesh_version = 1;
    writer.add(frame);
  }
  const auto pieces = read_transforms(folder.path())["pieces"];
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_EQ(pieces[0]["last_frame"], 0);
  EXPECT_EQ(pieces[1]["parent"], 0);
  EXPECT_EQ(pieces[2]["last_frame"], 1);
  EXPECT_EQ(pieces[3]["first_frame"], 2);
  EXPECT_EQ(pieces[3]["mesh_version"], 1);
}

TEST(Pieces, TheFileOfABodyHasTheFieldLastShown) {
  const TemporaryFolder folder;
  PieceWriter writer(folder.path(), 30);
  Frame frame;
  frame.scale = FieldScale{"strain_energy", "J/m3", 0, 1};
  frame.bodies = {body_of(make_box({1, 1, 1}, 0.5), 0)};
  const std::size_t corners = 3 * frame.bodies[0].mesh->triangle_count();
  const auto read = [&] {
    LoadLog log;
    return load_mesh((folder.path() / read_transforms(folder.path())["pieces"][0]["file"].get<std::string>()).string(),
                     {}, log);
  };
  writer.add(frame);
  EXPECT_TRUE(read().channels.empty());
  for (const float value : {2.0f, 3.0f}) {
    auto field = std::make_shared<SurfaceField>();
    field->value.assign(corners, value);
    frame.bodies[0].field = field;
    ++frame.index;
    writer.add(frame);
    const SurfaceMesh mesh = read();
    ASSERT_EQ(mesh.channels.size(), 1u);
    EXPECT_EQ(mesh.channels[0].name, "strain_energy");
    EXPECT_EQ(mesh.channels[0].value, field->value);
  }
  EXPECT_EQ(read_transforms(folder.path())["pieces"].size(), 1u);
}

TEST(Pieces, AnUnwritableFolderIsAnErrorWithItsName) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  std::ofstream(file) << "not a folder";
  EXPECT_NE(refusal([&] { PieceWriter(file / "pieces", 30); }).find((file / "pieces").string()), std::string::npos);
}

TEST(Pieces, ARunThatIsCutShortAfterAnyFrameHasItsMeshes) {
  const TemporaryFolder folder;
  PieceWriter writer(folder.path(), 30);
  Frame frame;
  frame.bodies = {body_of(make_box({1, 1, 1}, 0.5), 0)};
  writer.add(frame);
  frame.bodies[0].translation.x = std::numeric_limits<Real>::infinity();
  EXPECT_FALSE(refusal([&] { writer.add(frame); }).empty());
  const auto pieces = read_transforms(folder.path())["pieces"];
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0]["poses"].size(), 1u);
}

}  // namespace
}  // namespace sherd
