#pragma once
#include "viewer/app/exit_codes.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace tumble {

/// What a parsed command does; gives the exit code.
using CommandAction = std::function<int()>;

/// One subcommand: its name, one line for the list, and a function that declares its options on
/// `app` and says what to do with them once they are parsed. One more command: a file in
/// commands/, a line below and in commands.cpp, a test in tests/viewer/cli.
struct CommandEntry {
  std::string_view name;
  std::string_view doc;
  CommandAction (*declare)(CLI::App& app);
};

CommandAction declare_bench(CLI::App& app);
CommandAction declare_check(CLI::App& app);
CommandAction declare_compare(CLI::App& app);
CommandAction declare_doctor(CLI::App& app);
CommandAction declare_keys(CLI::App& app);
CommandAction declare_mesh(CLI::App& app);
CommandAction declare_open(CLI::App& app);
CommandAction declare_pack(CLI::App& app);
CommandAction declare_render(CLI::App& app);
CommandAction declare_scenes(CLI::App& app);
CommandAction declare_simulate(CLI::App& app);
CommandAction declare_verify(CLI::App& app);

/// Refuses what is not a whole number of 0 or more, without the range of 309 digits that CLI11
/// prints.
CLI::Validator natural_number();

/// Every subcommand in the order of the help.
const std::vector<CommandEntry>& all_commands();

/// The whole program after main's set-up: parses, runs and answers with an exit code.
int run_command_line(std::span<const std::string> arguments);

}  // namespace tumble
