#include "viewer/capture/states/state_list.hpp"

#include "engine/core/hash.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using StatesJson = nlohmann::ordered_json;

constexpr size_t most_state_bytes = size_t{1} << 36;

/// Throws nlohmann::json::exception if the value is not a text.
uint64_t hash_in(const StatesJson& text) {
  const auto digits = text.get<std::string>();
  uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

/// Throws nlohmann::json::exception if the value is not a valid list.
StateList list_of(const StatesJson& json) {
  StateList out;
  out.version = json.at("version").get<std::string>();
  out.scene = json.at("scene").get<std::string>();
  out.start = json.at("start").get<std::string>();
  out.run = json.at("run").get<std::string>();
  out.stepper = json.at("stepper").get<std::string>();
  out.overrides = json.at("set").get<std::vector<std::string>>();
  json.at("fps").at(0).get_to(out.fps.num);
  json.at("fps").at(1).get_to(out.fps.den);
  json.at("tick_hz").at(0).get_to(out.rate.num);
  json.at("tick_hz").at(1).get_to(out.rate.den);
  json.at("frames_wanted").get_to(out.frames_wanted);
  json.at("every_tick").get_to(out.every_tick);
  for (const StatesJson& state : json.at("states"))
    out.states.push_back({state.at("tick").get<uint64_t>(), hash_in(state.at("state_hash")),
                          hash_in(state.at("file_hash"))});
  return out;
}

/// Positive, and within the range of the integers used for times of frames.
bool is_term(int64_t number) {
  return number > 0 && number <= greatest_term;
}

bool is_sound(const StateList& list) {
  return is_term(list.fps.num) && is_term(list.fps.den) && is_term(list.rate.num) &&
         is_term(list.rate.den) &&
         std::ranges::is_sorted(list.states, std::less_equal<>{}, &SavedState::tick);
}

}  // namespace

const SavedState* StateList::find(uint64_t tick) const {
  const auto at = std::ranges::lower_bound(states, tick, {}, &SavedState::tick);
  return at != states.end() && at->tick == tick ? &*at : nullptr;
}

std::string state_file_name(uint64_t tick) {
  return fmt::format("state_{:08d}.bin", tick);
}

bool is_state_file_name(const std::string& name) {
  constexpr std::string_view front = "state_", back = ".bin";
  return name.size() >= state_file_name(0).size() && name.starts_with(front) &&
         name.ends_with(back) &&
         std::all_of(name.begin() + ptrdiff_t(front.size()), name.end() - ptrdiff_t(back.size()),
                     [](char c) { return c >= '0' && c <= '9'; });
}

Status write_state_list(const std::filesystem::path& folder, const StateList& list) {
  StatesJson out = {{"tumble_states", 1},
                    {"version", list.version},
                    {"scene", list.scene},
                    {"start", list.start},
                    {"run", list.run},
                    {"stepper", list.stepper},
                    {"set", list.overrides},
                    {"fps", {list.fps.num, list.fps.den}},
                    {"tick_hz", {list.rate.num, list.rate.den}},
                    {"frames_wanted", list.frames_wanted},
                    {"every_tick", list.every_tick},
                    {"states", StatesJson::array()}};
  for (const SavedState& state : list.states)
    out["states"].push_back({{"tick", state.tick},
                             {"state_hash", hash_text(state.state_hash)},
                             {"file_hash", hash_text(state.file_hash)}});
  return write_file(folder / state_list_name,
                    out.dump(1, ' ', false, StatesJson::error_handler_t::replace) + "\n");
}

Result<StateList> read_state_list(const std::filesystem::path& folder) {
  const auto path = folder / state_list_name;
  const std::string cure = "`tumble simulate SCENE --states DIR` saves states into a folder";
  const auto text = read_file(path);
  if (!text) {
    Error error = text.error();
    error.cure = cure;
    return error;
  }
  const Error bad{ErrorCode::parse, "not the list of saved states", path.string(), cure};
  const StatesJson json = StatesJson::parse(*text, nullptr, false);
  if (!json.is_object()) return bad;
  try {
    StateList list = list_of(json);
    if (is_sound(list)) return list;
  } catch (const StatesJson::exception&) {
  }
  return bad;
}

Result<std::string> read_state(const std::filesystem::path& folder, const SavedState& state) {
  const auto path = folder / state_file_name(state.tick);
  auto content = read_file(path, most_state_bytes);
  if (!content) return content.error();
  if (hash_bytes(content->data(), content->size()) != state.file_hash)
    return Error{ErrorCode::parse, "not the state that states.json tells of", path.string(),
                 "tumble simulate --states with --resume makes it anew"};
  return content;
}

size_t whole_states(const std::filesystem::path& folder, const StateList& list) {
  const auto broken = std::ranges::find_if(
      list.states, [&](const SavedState& state) { return !read_state(folder, state).ok(); });
  return size_t(broken - list.states.begin());
}

}  // namespace tumble
