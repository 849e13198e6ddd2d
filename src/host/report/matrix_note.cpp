// SPDX-License-Identifier: MIT
// What a report says of the matrix of a stiff method, for both real types.
#include "myriad/host/report/matrix_note.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class R>
void note_matrix(report_of<R>& r, const matrix_facts& facts) {
    r.matrix = facts;
    if (facts.lacks_pattern)
        r.notes.emplace_back(
            "rhs looks at values, of a state, a parameter or a shared integer, so that the compiler cannot find which "
            "entries of the Jacobian are zero, and the method works with all of them: use myriad::select instead of "
            "branches, or declare jacobian_pattern");
}
template void note_matrix(report_of<double>&, const matrix_facts&);
template void note_matrix(report_of<float>&, const matrix_facts&);

}  // namespace myriad::host::inline MYRIAD_ABI
