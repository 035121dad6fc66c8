#pragma once
/// What nearly every source of the house includes, compiled once (tumble_compile in the top
/// CMakeLists.txt). Not to be included by hand: a source names what it uses, and must compile
/// without this. Only headers of others: what changes with our work would compile everything anew.
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
