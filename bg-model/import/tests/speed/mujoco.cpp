// Times MuJoCo's forward dynamics of a robot without contacts and constraints: the least of 40 rounds.

#include <mujoco/mujoco.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>
int main(int, char** v) {
  char fault[1000];
  mjModel* m = mj_loadXML(v[1], nullptr, fault, sizeof fault);
  if (!m) { std::printf("%s: %s\n", v[1], fault); return 1; }
  m->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_CONSTRAINT;
  mjData* d = mj_makeData(m);
  auto draw = [] { return 2.0 * std::rand() / RAND_MAX - 1; };
  std::srand(1);
  const int n = 256;
  std::vector<std::vector<double>> q, u, t;
  for (int i = 0; i < n; ++i) {
    std::vector<double> x(m->qpos0, m->qpos0 + m->nq), s(m->nv), f(m->nv), w(m->nv);
    for (int k = 0; k < m->nv; ++k) { s[k] = draw(); f[k] = draw(); w[k] = draw(); }
    mj_integratePos(m, x.data(), s.data(), 1);
    q.push_back(x); u.push_back(w); t.push_back(f);
  }
  double best = 1e9, sum = 0;
  for (int r = 0; r < 40; ++r) {
    auto a = std::chrono::steady_clock::now();
    for (int k = 0; k < 8; ++k) for (int i = 0; i < n; ++i) {
      mju_copy(d->qpos, q[i].data(), m->nq); mju_copy(d->qvel, u[i].data(), m->nv);
      mju_copy(d->qfrc_applied, t[i].data(), m->nv);
      mj_fwdPosition(m, d); mj_fwdVelocity(m, d); mj_fwdActuation(m, d); mj_fwdAcceleration(m, d);
      sum += d->qacc_smooth[0];
    }
    auto b = std::chrono::steady_clock::now();
    best = std::min(best, std::chrono::duration<double, std::nano>(b - a).count() / (8 * n));
  }
  std::printf("%s: MuJoCo %d ns, %d freedoms%s\n", v[1], int(best), int(m->nv), sum == 0 ? "!" : "");
}
