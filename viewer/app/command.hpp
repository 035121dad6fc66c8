#pragma once
#include "viewer/app/exit_codes.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class Options;

/// The action of a parsed command; returns the exit code.
using CommandAction = std::function<int()>;

/// One subcommand: its name, one line for the list of commands, and a function that declares its
/// options and returns the action to run once they are parsed. To add a command: a file in
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

/// Everything main does after its set-up: parses, runs and returns the exit code.
int run_command_line(std::span<const std::string> arguments);

}  // namespace tumble
