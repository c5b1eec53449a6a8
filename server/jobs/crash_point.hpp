#pragma once
/// The crash points live on the floor below, because the blob store has some too.
#include "server/store/crash_point.hpp"  // IWYU pragma: export
