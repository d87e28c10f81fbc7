#include "render/movie.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

#include "kernels/core/error.h"

namespace sherd {
namespace {

// Full path of a program on PATH; empty when there is none.
std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  const std::string list = path ? path : "";
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(':', begin), list.size());
    const std::string candidate = list.substr(begin, end - begin) + "/" + name;
    if (end > begin && access(candidate.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(candidate))
      return candidate;
    begin = end + 1;
  }
  return {};
}

struct RunResult {
  int status = -1;     // exit code; -1 when not started or killed
  std::string output;  // standard error
};

// In a fresh child: becomes the program, with errors to `errors`, and dies with its parent: a movie still being written
// for a killed run would meet the one of the run that goes on. Only what a signal handler may call.
[[noreturn]] void become(char* const* argv, int errors, pid_t parent) {
  const int nothing = open("/dev/null", O_RDWR);
  const bool ready = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent && nothing >= 0 &&
                     dup2(nothing, 0) == 0 && dup2(nothing, 1) == 1 && dup2(errors, 2) == 2;
  if (ready) execv(argv[0], argv);
  _exit(127);
}

// Runs a program with the given arguments, no shell, nothing on its standard input.
RunResult run(const std::vector<std::string>& arguments) {
  RunResult result;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return {-1, std::strerror(errno)};
  std::vector<char*> argv;
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));  // exec does not write to them
  argv.push_back(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become(argv.data(), ends[1], parent);
  const int failed = child < 0 ? errno : 0;
  close(ends[1]);
  if (failed != 0) {
    close(ends[0]);
    return {-1, std::strerror(failed)};
  }
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t n = read(ends[0], buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    result.output.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
  return result;
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  const std::size_t at = text.find_last_of("\r\n");
  return at == std::string::npos ? text : text.substr(at + 1);
}

// The picture reader expands % in the whole path; only the pattern's own may count.
std::string escaped(const std::filesystem::path& folder) {
  std::string out;
  for (const char c : folder.string()) out += c == '%' ? std::string("%%") : std::string(1, c);
  return out;
}

}  // namespace

MovieResult encode_movie(const std::filesystem::path& folder, const std::string& pattern, int first_number, Real fps,
                         const std::filesystem::path& movie) {
  MovieResult result;
  if (!(fps > 0) || !std::isfinite(fps)) {
    result.reason = "no movie: the frame rate must be positive";
    return result;
  }
  const std::string program = find_program("ffmpeg");
  if (program.empty()) {
    result.reason = "no movie: ffmpeg is not on PATH; install it, or encode the pictures with another program";
    return result;
  }
  std::filesystem::path part = movie;
  part += ".part";
  const std::string rate = fmt::format("{}", fps);
  std::string complaint;
  for (const std::string encoder : {"libx264", "mpeg4"}) {
    const bool h264 = encoder == "libx264";
    std::vector<std::string> arguments{program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y"};
    for (const std::string& a :
         {std::string("-framerate"), rate, std::string("-start_number"), std::to_string(first_number),
          std::string("-i"), "file:" + escaped(folder) + "/" + pattern, std::string("-vf"),
          std::string("pad=ceil(iw/2)*2:ceil(ih/2)*2"), std::string("-c:v"), encoder, std::string("-pix_fmt"),
          std::string("yuv420p"), std::string(h264 ? "-crf" : "-q:v"), std::string(h264 ? "18" : "2"),
          std::string("-movflags"), std::string("+faststart"), std::string("-f"), std::string("mp4"),
          "file:" + part.string()})
      arguments.push_back(a);
    const RunResult encoded = run(arguments);
    std::error_code failed;
    if (encoded.status == 0) {
      std::filesystem::rename(part, movie, failed);
      if (!failed) {
        result.made = true, result.encoder = encoder;
        return result;
      }
      complaint = failed.message();
    } else {
      complaint = last_line(encoded.output);
    }
    std::filesystem::remove(part, failed);
  }
  result.failed = true;
  result.reason = fmt::format("no movie: ffmpeg could not write {} ({}); the pictures in {} are complete",
                              movie.string(), complaint, folder.string());
  return result;
}

}  // namespace sherd
