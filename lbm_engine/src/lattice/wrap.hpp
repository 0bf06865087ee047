#pragma once

namespace lbm {

/// i modulo n, from 0 to n - 1.
inline int wrap(int i, int n)
{
    const int r = i % n;
    return r < 0 ? r + n : r;
}

}  // namespace lbm
