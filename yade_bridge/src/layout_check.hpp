#pragma once

namespace yadelbm {

/**
 * Verifies that the declarations of YADE's classes are those of the YADE that runs: objects are made through YADE's own
 * Python interface, filled with sentinels and compared. Leaves the scene as it was.
 * @throws LayoutMismatch  with the first difference
 */
void check_layout();

}  // namespace yadelbm
