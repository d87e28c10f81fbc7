// sherd-bench: speed, never correctness (the tests have that). Subcommands so that each study keeps its own options.
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  CLI::App app{"sherd-bench: benchmarks of sherd"};
  app.require_subcommand(1);
  CLI::App* micro = app.add_subcommand("micro", "times of single stages; takes Google Benchmark's options");
  micro->allow_extras();
  micro->footer(
      "Examples:\n  sherd-bench micro\n  sherd-bench micro --benchmark_filter=Operator --benchmark_format=json");
  CLI11_PARSE(app, argc, argv);
  std::vector<std::string> rest = micro->remaining();
  std::vector<char*> arguments{argv[0]};
  for (std::string& a : rest) arguments.push_back(a.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
