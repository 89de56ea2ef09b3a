#include "core/tools/portable_exponential.hpp"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "clog/core/tools/check_sum64.hpp"

namespace clog {
namespace {

// The expected numbers were recorded with Boost 1.74 on x86-64. Obstacle arrays depend on these numbers, so
// every version of Boost must draw the same.
TEST(PortableExponential, DrawsTheRecordedNumbers) {
  boost::random::mt19937_64 engine;
  boost::random::exponential_distribution<double> draw;
  std::vector<double> drawn(4096);
  for (double& number : drawn) number = draw(engine);
  const std::vector<double> first = {0x1.ef4e63e08c0d2p-1, 0x1.e4ad17810edep-1,  0x1.7130313d582a3p-3,
                                     0x1.6060b518163acp+0, 0x1.032ad02d90972p-6, 0x1.26a2271a79b59p-2,
                                     0x1.cb37b4becc92ep-1, 0x1.29035975a33a5p-5, 0x1.b59e16e83d312p-2,
                                     0x1.f24e62078aac7p-1};
  EXPECT_EQ(std::vector(drawn.begin(), drawn.begin() + 10), first);
  EXPECT_EQ(hexadecimal(check_sum64(std::as_bytes(std::span(drawn)))), "0cd405aa18266b26");
}

}  // namespace
}  // namespace clog
