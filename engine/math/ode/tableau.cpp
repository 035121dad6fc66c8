#include "engine/math/ode/tableau.hpp"

namespace tumble::ode {

namespace {

Tableau make_dormand_prince() {
  Tableau t;
  t.stages = 7;
  t.order = 5;
  t.c = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  t.a[1] = {1.0 / 5};
  t.a[2] = {3.0 / 40, 9.0 / 40};
  t.a[3] = {44.0 / 45, -56.0 / 15, 32.0 / 9};
  t.a[4] = {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729};
  t.a[5] = {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656};
  t.a[6] = {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84};
  t.b = t.a[6];
  t.error = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  t.dense[0] = {1, -8048581381.0 / 2820520608.0, 8663915743.0 / 2820520608.0,
                -12715105075.0 / 11282082432.0};
  t.dense[2] = {0, 131558114200.0 / 32700410799.0, -68118460800.0 / 10900136933.0,
                87487479700.0 / 32700410799.0};
  t.dense[3] = {0, -1754552775.0 / 470086768.0, 14199869525.0 / 1410260304.0,
                -10690763975.0 / 1880347072.0};
  t.dense[4] = {0, 127303824393.0 / 49829197408.0, -318862633887.0 / 49829197408.0,
                701980252875.0 / 199316789632.0};
  t.dense[5] = {0, -282668133.0 / 205662961.0, 2019193451.0 / 616988883.0,
                -1453857185.0 / 822651844.0};
  t.dense[6] = {0, 40617522.0 / 29380423.0, -110615467.0 / 29380423.0, 69997945.0 / 29380423.0};
  return t;
}

}  // namespace

const Tableau& euler_tableau() {
  static const Tableau tableau = [] {
    Tableau t;
    t.b = {1};
    t.dense[0] = {1};
    return t;
  }();
  return tableau;
}

const Tableau& midpoint_tableau() {
  static const Tableau tableau = [] {
    Tableau t;
    t.stages = 2;
    t.order = 2;
    t.c = {0, 0.5};
    t.a[1] = {0.5};
    t.b = {0, 1};
    t.dense[0] = {1, -1};
    t.dense[1] = {0, 1};
    return t;
  }();
  return tableau;
}

const Tableau& classical_tableau() {
  static const Tableau tableau = [] {
    Tableau t;
    t.stages = 4;
    t.order = 4;
    t.c = {0, 0.5, 0.5, 1};
    t.a[1] = {0.5};
    t.a[2] = {0, 0.5};
    t.a[3] = {0, 0, 1};
    t.b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    t.dense[0] = {1, -3.0 / 2, 2.0 / 3};
    t.dense[1] = {0, 1, -2.0 / 3};
    t.dense[2] = {0, 1, -2.0 / 3};
    t.dense[3] = {0, -1.0 / 2, 2.0 / 3};
    return t;
  }();
  return tableau;
}

const Tableau& dormand_prince_tableau() {
  static const Tableau tableau = make_dormand_prince();
  return tableau;
}

}  // namespace tumble::ode
