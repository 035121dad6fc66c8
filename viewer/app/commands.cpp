#include "engine/core/text.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/options.hpp"
#include "viewer/app/scenes/scene_files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace tumble {
namespace {

constexpr std::string_view top_footer =
    "Examples:\n"
    "  tumble                                   the demolition scene in a window\n"
    "  tumble open tower                        another scene; `tumble scenes` lists them\n"
    "  tumble render tower -o out --seconds 4   the same without a display, as PNG files\n"
    "  tumble simulate tower --seconds 10 --csv energies.csv\n"
    "  tumble check my_scene.json               what is wrong with it, line by line\n\n"
    "Exit codes: 0 success; 1 a negative answer; 2 bad usage; 3 bad scene or asset; 4 no usable\n"
    "renderer; 5 output could not be written; 6 the simulation broke down; 7 not enough memory;\n"
    "130, 143 interrupted.";

/// `tumble SCENE` means `tumble open SCENE`, and `tumble` alone opens the default scene.
std::vector<std::string> with_command(std::span<const std::string> arguments) {
  std::vector<std::string> out(arguments.begin(), arguments.end());
  if (out.empty()) return {"open"};
  const auto& commands = all_commands();
  const bool named = std::any_of(commands.begin(), commands.end(),
                                 [&](const CommandEntry& c) { return c.name == out[0]; });
  if (!named && !out[0].starts_with('-')) out.insert(out.begin(), "open");
  return out;
}

/// A single word that is neither a command nor a scene is probably a misspelt command.
std::string misspelt_command(std::span<const std::string> arguments) {
  if (arguments.empty()) return {};
  const std::string& word = arguments[0];
  if (word.starts_with('-') || word.find_first_of("./") != std::string::npos) return {};
  std::vector<std::string> names;
  for (const CommandEntry& c : all_commands()) {
    if (c.name == word) return {};
    names.emplace_back(c.name);
  }
  if (std::error_code code; std::filesystem::exists(word, code)) return {};
  for (const std::string& scene : scene_names()) {
    if (scene == word) return {};
    names.push_back(scene);
  }
  return unknown_name("command or scene", word, names);
}

/// Advice for an unexpected word: the value of a flag may only follow after "=".
std::string cure_of_extras(const CLI::App& command, std::span<const std::string> arguments) {
  for (size_t i = 0; i + 1 < arguments.size(); ++i) {
    const std::string &name = arguments[i], &next = arguments[i + 1];
    const CLI::Option* option = command.get_option_no_throw(name);
    if (!option || !name.starts_with("--") || next.starts_with('-')) continue;
    const bool takes_value =
        option->get_expected_max() == 0 && option->get_flag_value(name.substr(2), "") != "true";
    if (takes_value) return fmt::format("if {1} is the value of {0}, write {0}={1}; ", name, next);
  }
  return {};
}

/// Advice for a file that is taken for an option because of its name.
std::string cure_of_dashes(std::span<const std::string> arguments) {
  for (const std::string& word : arguments)
    if (std::error_code none;
        word.starts_with('-') && word != "-" && std::filesystem::exists(word, none))
      return fmt::format("the file {0} is named as ./{0}; ", word);
  return {};
}

/// Reports that stdout could not be written, with the cause if it is known.
int report_stdout(const std::error_code& cause) {
  return report({ErrorCode::io, "cannot write" + (cause ? ": " + cause.message() : std::string()),
                 "stdout", "see whether its file has room, or what reads it still runs"},
                exit_cannot_write);
}

/// Flushes stdout and returns `code`, or the code for an output that could not be written.
int flushed(int code) {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return code;
  const int unwritten = report_stdout(std::error_code(errno, std::generic_category()));
  return code == exit_ok || code == exit_negative ? unwritten : code;
}

/// Runs a command; output that cannot be written ends with exit code 5, no matter which layer
/// notices it.
int run_action(const CommandAction& action) {
  try {
    return flushed(action());
  } catch (const std::system_error& fault) {  // thrown by fmt::print
    if (!std::ferror(stdout)) throw;
    return report_stdout(fault.code());
  }
}

}  // namespace

const std::vector<CommandEntry>& all_commands() {
  static const std::vector<CommandEntry> entries = {
      {"open", "open a scene in a window (the default command)", declare_open},
      {"render", "render a scene to a sequence of PNG files, without a display", declare_render},
      {"compare", "compare two pictures or two folders of pictures", declare_compare},
      {"simulate", "simulate without pictures: energies, hashes, assertions", declare_simulate},
      {"verify", "the same scene twice, side by side: where two settings part", declare_verify},
      {"check", "validate scene files", declare_check},
      {"pack", "a scene with its files as one file", declare_pack},
      {"scenes", "list the scenes that can be opened by name", declare_scenes},
      {"mesh", "describe a mesh file: triangles, volume, inertia", declare_mesh},
      {"keys", "what the keys of the window do, and how to change them", declare_keys},
      {"bench", "time fixed workloads, and measure what they leave behind", declare_bench},
      {"doctor", "which ways to draw work on this machine, and how to cure the others",
       declare_doctor},
  };
  return entries;
}

int run_command_line(std::span<const std::string> arguments) {
  if (const std::string wrong = misspelt_command(arguments); !wrong.empty())
    return report({ErrorCode::invalid_argument, wrong, {}, "see `tumble --help`"}, exit_usage);

  CLI::App app("Tumble, a physics sandbox and a headless renderer of its scenes.", "tumble");
  app.set_version_flag("--version", "tumble " TUMBLE_VERSION, "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.footer(std::string(top_footer));
  app.require_subcommand(0, 1);
  CommandAction action;
  for (const CommandEntry& entry : all_commands()) {
    CLI::App* sub = app.add_subcommand(std::string(entry.name), std::string(entry.doc));
    sub->set_help_flag("-h,--help", "print this help");
    Options options(*sub);
    sub->final_callback([&action, run = entry.declare(options)] { action = run; });
  }

  std::vector<std::string> reversed = with_command(arguments);
  std::reverse(reversed.begin(), reversed.end());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::Success& asked) {  // --help, --version
    return flushed(app.exit(asked) == 0 ? exit_ok : exit_usage);
  } catch (const CLI::ParseError& fault) {
    const auto used = app.get_subcommands();
    const std::string help = used.empty() ? "tumble" : "tumble " + used.front()->get_name();
    const bool extras = dynamic_cast<const CLI::ExtrasError*>(&fault) && !used.empty();
    const std::string cure =
        cure_of_dashes(arguments) + (extras ? cure_of_extras(*used.front(), arguments) : "");
    return report(
        {ErrorCode::invalid_argument, fault.what(), {}, cure + "see `" + help + " --help`"},
        exit_usage);
  }
  return action ? run_action(action) : flushed(exit_usage);
}

}  // namespace tumble
