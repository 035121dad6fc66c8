#pragma once
#include "viewer/app/exit_codes.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class Options;

/// What a parsed command does; gives the exit code.
using CommandAction = std::function<int()>;

/// One subcommand: its name, one line for the list, and a function that declares its
/// options and says what to do with them once they are parsed. One more command: a file in
/// commands/, a line below and in commands.cpp, a test in tests/viewer/cli.
struct CommandEntry {
  std::string_view name;
  std::string_view doc;
  CommandAction (*declare)(Options& options);
};

CommandAction declare_bench(Options& options);
CommandAction declare_check(Options& options);
CommandAction declare_compare(Options& options);
CommandAction declare_doctor(Options& options);
CommandAction declare_keys(Options& options);
CommandAction declare_mesh(Options& options);
CommandAction declare_open(Options& options);
CommandAction declare_pack(Options& options);
CommandAction declare_render(Options& options);
CommandAction declare_scenes(Options& options);
CommandAction declare_simulate(Options& options);
CommandAction declare_verify(Options& options);

/// Every subcommand in the order of the help.
const std::vector<CommandEntry>& all_commands();

/// The whole program after main's set-up: parses, runs and answers with an exit code.
int run_command_line(std::span<const std::string> arguments);

}  // namespace tumble
