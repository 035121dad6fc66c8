#pragma once
/// Headers that nearly every source includes, precompiled (tumble_compile in the top
/// CMakeLists.txt). Not to be included by hand: a source includes what it uses, and must compile
/// without this. Only headers of the standard library and other libraries: any change of a header
/// of our own would recompile everything.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
