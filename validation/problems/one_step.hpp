// SPDX-License-Identifier: MIT
// One step of each method on the timed circle, from published coefficients in 60 decimal digits. Written by
// one_step.py.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace validation {

inline constexpr double one_step_length = 0.5, one_step_angle = 0.75;

inline const std::map<std::string, std::vector<double>> one_step = {
    {"runge_kutta_4", {2.6641360667791920351695558, 1.2142426826676247873331841}},
    {"cash_karp", {2.6665858018970570638472313, 1.2148842161977912423467714}},
    {"tsitouras_5", {2.6668955881769898147028845, 1.2147704217071113560494093}},
    {"dormand_prince_5", {2.6667858858789265664249055, 1.2147631647326346638210618}},
    {"verner_7", {2.6668759405793983229847279, 1.2147422459259017479237703}},
    {"dormand_prince_8", {2.6668379712560660816986529, 1.2147617332711709189699390}},
    {"verner_9", {2.6668366877583652205170674, 1.2147614484132770045668751}},
};

}  // namespace validation
