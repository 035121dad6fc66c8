#pragma once

/// Elementary functions built from + - * / and sqrt only, so that their bits are the same on every
/// CPU, compiler and C library. Code that changes simulation state calls these instead of <cmath>.
/// Errors are given in units in the last place (ulp) and tested against extended precision.
namespace tumble::det {

constexpr double pi = 3.14159265358979323846;

/// Within 1 ulp for |x| <= 1e5; larger arguments are reduced with less accuracy, and non-finite
/// ones give NaN.
double sin(double x);
double cos(double x);
/// Within 2 ulp; domain errors give NaN.
double atan(double x);
double atan2(double y, double x);
double acos(double x);
double asin(double x);
double exp(double x);
double log(double x);
/// x^y for x >= 0 (any y), and for x < 0 with integer y.
double pow(double x, double y);

}  // namespace tumble::det
