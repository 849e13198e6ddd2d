// SPDX-License-Identifier: MIT
// Parameter studies: axes by name, what is kept, results in memory or on disk. Needs the target myriad::study.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/study/axes.hpp"
#include "myriad/study/model_study.hpp"
#include "myriad/study/reduction.hpp"
#include "myriad/study/study.hpp"
