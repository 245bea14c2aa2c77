// Functions of the C library whose last bit differs between systems, with the same bits on every system.
//
// They consist of additions, multiplications, divisions, roots and integers, which IEEE 754 rounds alike everywhere,
// and are compiled without fused multiply-adds. Arguments outside of the domain give NaN. errno is not set.
// Errors are in units of the result's last place, measured against numbers of 64 bits (tests/base/functions_test.cpp).
#pragma once

namespace riffler::base {

double sin(double x);              ///< x in rad, of any size; error < 0.8
double cos(double x);              ///< x in rad, of any size; error < 0.8
double tan(double x);              ///< x in rad, of any size; error < 1
double asin(double x);             ///< rad in [−π/2, π/2]; error < 0.7
double acos(double x);             ///< rad in [0, π]; error < 0.7
double atan(double x);             ///< rad in [−π/2, π/2]; error < 0.7
double atan2(double y, double x);  ///< rad in [−π, π]; signs of zeros and infinities as in std::atan2; error < 0.7
double exp(double x);              ///< error < 0.6
double expm1(double x);            ///< exp(x) − 1, exact to the last places for small x; error < 0.7
double log(double x);              ///< error < 0.6
double log2(double x);             ///< error < 0.6
double log10(double x);            ///< error < 0.6
double pow(double x, double y);    ///< exponents, zeros and infinities as in std::pow; error < 0.6
double tanh(double x);             ///< error < 0.7

}  // namespace riffler::base
