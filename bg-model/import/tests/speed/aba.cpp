// Times Pinocchio's aba and computeABADerivatives for a robot that dump.py has written: the least of 40 rounds.

#include <pinocchio/fwd.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <chrono>
#include <iostream>
#include <fstream>
#include <vector>
using namespace pinocchio;
int main(int c, char** v) {
  Model model; std::ifstream f(v[1]); int parent; std::string k; int count = 0;
  while (f >> parent >> k) {
    Eigen::Matrix3d R, I; Eigen::Vector3d p, a, l; double m;
    for (int i = 0; i < 9; ++i) f >> R(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) f >> p[i];
    for (int i = 0; i < 3; ++i) f >> a[i];
    f >> m; for (int i = 0; i < 3; ++i) f >> l[i];
    for (int i = 0; i < 9; ++i) f >> I(i / 3, i % 3);
    SE3 s(R, p); std::string n = "j" + std::to_string(count++); JointIndex id;
    if (k == "rx") id = model.addJoint(parent, JointModelRX(), s, n); else if (k == "ry") id = model.addJoint(parent, JointModelRY(), s, n); else if (k == "rz") id = model.addJoint(parent, JointModelRZ(), s, n);
    else if (k == "px") id = model.addJoint(parent, JointModelPX(), s, n); else if (k == "py") id = model.addJoint(parent, JointModelPY(), s, n); else if (k == "pz") id = model.addJoint(parent, JointModelPZ(), s, n);
    else if (k == "ff") id = model.addJoint(parent, JointModelFreeFlyer(), s, n); else if (k == "ru") id = model.addJoint(parent, JointModelRevoluteUnaligned(a), s, n); else id = model.addJoint(parent, JointModelPrismaticUnaligned(a), s, n);
    model.appendBodyToJoint(id, Inertia(m, l, I), SE3::Identity());
  }
  Data data(model); const int n = 256; std::vector<Eigen::VectorXd> q, u, t; srand(1);
  for (int i = 0; i < n; ++i) { Eigen::VectorXd x = neutral(model); Eigen::VectorXd d = Eigen::VectorXd::Random(model.nv); q.push_back(integrate(model, x, d)); u.push_back(Eigen::VectorXd::Random(model.nv)); t.push_back(Eigen::VectorXd::Random(model.nv)); }
  double best = 1e9, bestd = 1e9, s = 0;
  for (int r = 0; r < 40; ++r) {
    auto a = std::chrono::steady_clock::now();
    for (int k = 0; k < 8; ++k) for (int i = 0; i < n; ++i) s += aba(model, data, q[i], u[i], t[i], Convention::LOCAL)[0];
    auto b = std::chrono::steady_clock::now();
    best = std::min(best, std::chrono::duration<double, std::nano>(b - a).count() / (8 * n));
    a = std::chrono::steady_clock::now();
    for (int i = 0; i < n; ++i) { computeABADerivatives(model, data, q[i], u[i], t[i]); s += data.ddq_dq(0, 0); }
    b = std::chrono::steady_clock::now();
    bestd = std::min(bestd, std::chrono::duration<double, std::nano>(b - a).count() / n);
  }
  std::cout << v[1] << ": aba " << int(best) << " ns, computeABADerivatives " << int(bestd) << " ns" << (s == 0 ? "!" : "") << "\n";
}
