#include <gtest/gtest.h>
#include <chrono>
#include <cstdio>
#include "generator/hidden/draw.hpp"
TEST(Temp, temp) {
  using namespace chaintrue::generator;
  TrueMachine m; m.compliance_per_n=5.1685e-6; m.wheel=WheelShape::round;
  auto r=come_to_rest(m,{0,0}); printf("%.9f %.9f\n", r->chain[0].length_mm, r->chain[0].length_mm-1701.6966936575451);
  r=come_to_rest(m,{-1219.2,-609.6}); printf("%.9f %.9f\n", r->chain[0].length_mm-1578.0862445159099, r->chain[1].length_mm-3059.3434651166107);
  m.wheel=WheelShape::teeth;
  r=come_to_rest(m,{-1219.2,-609.6}); printf("%.9f %.9f\n", r->chain[0].length_mm-1578.0862445159099, r->chain[1].length_mm-3059.3434651166107);
  for (int pts : {28,60,117}) for (int k=0;k<3;++k){ auto t=std::chrono::steady_clock::now();
    auto s=draw_set({.kind=Mix::single,.points=pts}, 100+k);
    printf("%d %.1f ms %s %s %g %g d %.3f rho %.3f %s %d\n", pts, std::chrono::duration<double>(std::chrono::steady_clock::now()-t).count()*1e3, card(s.answer.hidden[0].cause).id.data(), word(s.answer.hidden[0].where).data(), s.answer.hidden[0].size, s.answer.hidden[0].place, s.answer.delta[0], s.answer.nearest_rho, card(s.answer.nearest).id.data(), s.answer.separable);}
}
