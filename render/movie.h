// Frames to a movie through the ffmpeg program, when there is one.
#pragma once
#include <filesystem>
#include <string>

#include "kernels/core/vec3.h"

namespace sherd {

struct MovieResult {
  bool made = false;
  std::string encoder;  // "libx264" or "mpeg4" when made
  bool failed = false;  // ffmpeg is there, but could not make it
  std::string reason;   // why not, with the remedy, when not made
};

// Encodes folder/pattern (ffmpeg's own form, e.g. "frame_%05d.png", counted from first_number) at `fps` pictures a
// second. H.264 at quality 18 where ffmpeg has it, else MPEG-4; yuv420p, an odd side is padded by one pixel. `movie`
// ends in .mp4 and appears only when complete. Never throws for a missing or failing ffmpeg: the pictures are there
// either way.
MovieResult encode_movie(const std::filesystem::path& folder, const std::string& pattern, int first_number, Real fps,
                         const std::filesystem::path& movie);

}  // namespace sherd
