#pragma once

namespace lbm {

/**
 * The D3Q27 velocity set: c[i], weights w[i], c_s^2 = 1/3, isotropic to fourth order in every direction. Numbered like D3Q19 with the
 * four pairs along the diagonals of the cube behind: 0 is at rest, (1, 2), (3, 4), ... (25, 26) are opposite.
 */
struct D3Q27 {
    static constexpr int Q = 27;
    static constexpr int kPairs = 13;

    static constexpr int c[Q][3] = {{0, 0, 0},                  //
                                    {1, 0, 0},   {-1, 0, 0},    //
                                    {0, 1, 0},   {0, -1, 0},    //
                                    {0, 0, 1},   {0, 0, -1},    //
                                    {1, 1, 0},   {-1, -1, 0},   //
                                    {1, -1, 0},  {-1, 1, 0},    //
                                    {1, 0, 1},   {-1, 0, -1},   //
                                    {1, 0, -1},  {-1, 0, 1},    //
                                    {0, 1, 1},   {0, -1, -1},   //
                                    {0, 1, -1},  {0, -1, 1},    //
                                    {1, 1, 1},   {-1, -1, -1},  //
                                    {1, 1, -1},  {-1, -1, 1},   //
                                    {1, -1, 1},  {-1, 1, -1},   //
                                    {1, -1, -1}, {-1, 1, 1}};

    static constexpr double w(int i) { return i == 0 ? 8.0 / 27 : i < 7 ? 2.0 / 27 : i < 19 ? 1.0 / 54 : 1.0 / 216; }
    static constexpr int opposite(int i) { return i == 0 ? 0 : i % 2 == 1 ? i + 1 : i - 1; }
};

}  // namespace lbm
