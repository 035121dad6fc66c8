#pragma once
#include <array>
#include <cstddef>

namespace tumble::ode {

/// Coefficients of an explicit Runge-Kutta method of s stages:
///   k_i = f(t + c_i h, y0 + h sum_{j<i} a_ij k_j),   y1 = y0 + h sum_i b_i k_i,
/// with a dense output y(t0 + theta h) = y0 + h sum_i k_i sum_m dense_im theta^m (m from 1) and,
/// where it has one, an error estimate h sum_i error_i k_i.
struct Tableau {
  static constexpr size_t max_stages = 7, max_degree = 4;
  size_t stages = 1;
  int order = 1;
  std::array<double, max_stages> c{}, b{}, error{};
  std::array<std::array<double, max_stages>, max_stages> a{};
  std::array<std::array<double, max_degree>, max_stages> dense{};
};

const Tableau& euler_tableau();
/// The midpoint rule; dense output of local error O(h^3).
const Tableau& midpoint_tableau();
/// Kutta's method of 1901; dense output of local error O(h^4) (Hairer, Norsett, Wanner, Solving
/// Ordinary Differential Equations I, II.6).
const Tableau& classical_tableau();
/// Dormand and Prince 1980, "A family of embedded Runge-Kutta formulae", 5(4); its last stage is
/// the derivative at the end of the step. Dense output of local error O(h^5) (Shampine 1986;
/// Hairer, Norsett, Wanner, II.6).
const Tableau& dormand_prince_tableau();

}  // namespace tumble::ode
