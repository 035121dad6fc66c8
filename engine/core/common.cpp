// Nothing but common.hpp, precompiled for the targets that are optimised little (tumble_compile).
#include "engine/core/common.hpp"
