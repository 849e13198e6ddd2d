// SPDX-License-Identifier: MIT
// Parameter studies: axes by name, what is kept, results in memory or on disk, and exports. Needs the target
// myriad::study.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include "myriad/myriad.hpp"
#include "myriad/study/export/export.hpp"
#include "myriad/study/model_study.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/reduction.hpp"
#include "myriad/study/store/store.hpp"
#include "myriad/study/study.hpp"
