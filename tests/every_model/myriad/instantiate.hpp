// SPDX-License-Identifier: MIT
// Stands for <myriad/instantiate.hpp> in files with MYRIAD_INSTANTIATE: instead of compiling kernels, it has the
// derivatives of the model checked. In this way every model of the repository is covered, new ones too.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/core/macros.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "tests/every_model/derivatives.hpp"

#define MYRIAD_INSTANTIATE(Model, ...) MYRIAD_CHECK_DERIVATIVES(Model, __COUNTER__)
#define MYRIAD_INSTANTIATE_FLOAT(Model, ...) MYRIAD_CHECK_DERIVATIVES(Model, __COUNTER__)
#define MYRIAD_CHECK_DERIVATIVES(Model, number) MYRIAD_CHECK_DERIVATIVES_NUMBER(Model, number)
#define MYRIAD_CHECK_DERIVATIVES_NUMBER(Model, number)                                             \
    namespace every_model {                                                                        \
    [[maybe_unused]] static const bool checked_##number = every_model::checks<Model>::add(#Model); \
    }
