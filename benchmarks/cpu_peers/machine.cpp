// SPDX-License-Identifier: MIT
// Describes the machine and the build for the header of the output.
#include "machine.hpp"

#include <cstdio>
#include <fstream>

#include "lorenz_rk4/equations.hpp"

namespace cpu_peers {
namespace {

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const auto colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::string commit() {
    std::string text;
    std::FILE* const pipe = popen("git -C '" CPU_PEERS_SOURCE_DIR "' describe --always --dirty 2>/dev/null", "r");
    if (pipe == nullptr) return "unknown";
    for (int c = std::fgetc(pipe); c != EOF && c != '\n'; c = std::fgetc(pipe)) text += static_cast<char>(c);
    return pclose(pipe) == 0 && !text.empty() ? text : "unknown";
}

// $<$<CONFIG:Release>:-O3> leaves a gap in other configurations.
std::string tidy(const std::string& text) {
    std::string result;
    for (const char c : text)
        if (c != ' ' || (!result.empty() && result.back() != ' ')) result += c;
    if (!result.empty() && result.back() == ' ') result.pop_back();
    return result;
}

}  // namespace

std::string compiler() { return CPU_PEERS_COMPILER; }

std::string instruction_set() {
    const std::string target = lorenz::instruction_set();  // such as openmp_avx512
    return target.substr(target.find('_') + 1);
}

std::vector<std::string> describe_machine() {
    return {"compiler: " CPU_PEERS_COMPILER " (" __VERSION__ ")",
            "flags of Myriad's models and of packs_as_models: " + tidy(CPU_PEERS_MODEL_FLAGS),
            "flags of all peers: " + tidy(CPU_PEERS_PEER_FLAGS) +
                " (contraction is allowed, so that they are not held back)",
            "CPU: " + cpu_name(),
            "instruction set of models: " + instruction_set(),
            "commit: " + commit()};
}

}  // namespace cpu_peers
