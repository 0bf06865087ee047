#pragma once

#include <array>

namespace lbm {

/**
 * The D3Q19 velocity set: c[i], weights w[i], c_s^2 = 1/3. Opposite directions stand next to each other:
 * 0 is at rest, (1, 2), (3, 4), ... (17, 18) are the nine opposite pairs.
 * @see Qian, d'Humieres & Lallemand (1992), Europhys. Lett. 17, 479
 */
struct D3Q19 {
    static constexpr int Q = 19;
    static constexpr int kPairs = 9;

    static constexpr int c[Q][3] = {{0, 0, 0},                //
                                    {1, 0, 0},  {-1, 0, 0},   //
                                    {0, 1, 0},  {0, -1, 0},   //
                                    {0, 0, 1},  {0, 0, -1},   //
                                    {1, 1, 0},  {-1, -1, 0},  //
                                    {1, -1, 0}, {-1, 1, 0},   //
                                    {1, 0, 1},  {-1, 0, -1},  //
                                    {1, 0, -1}, {-1, 0, 1},   //
                                    {0, 1, 1},  {0, -1, -1},  //
                                    {0, 1, -1}, {0, -1, 1}};

    static constexpr double w(int i) { return i == 0 ? 1.0 / 3 : i < 7 ? 1.0 / 18 : 1.0 / 36; }
    static constexpr int opposite(int i) { return i == 0 ? 0 : i % 2 == 1 ? i + 1 : i - 1; }
};

}  // namespace lbm
