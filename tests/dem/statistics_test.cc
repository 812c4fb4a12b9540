#include "dem/measure/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace densify::dem;

// 2, 4, 4, 4, 5, 5, 7, 9: mean 5, squares about it 32, so s = sqrt(32/7).
TEST(Statistics, ByHand) {
  const Statistics s = statistics({9, 4, 5, 4, 2, 5, 4, 7});
  EXPECT_EQ(s.number, 8u);
  EXPECT_DOUBLE_EQ(s.mean, 5);
  EXPECT_DOUBLE_EQ(s.standard_deviation, std::sqrt(32.0 / 7));
  EXPECT_EQ(s.minimum, 2);
  EXPECT_EQ(s.maximum, 9);
  EXPECT_EQ(s.median, 4.5);
  EXPECT_EQ(statistics({3, 1, 2}).median, 2);
}

TEST(Statistics, OfLittle) {
  EXPECT_EQ(statistics({}).number, 0u);
  EXPECT_TRUE(std::isnan(statistics({}).mean));
  EXPECT_EQ(statistics({3}).mean, 3);
  EXPECT_TRUE(std::isnan(statistics({3}).standard_deviation));
}

// -5 ... 1000 in steps of one: five values lie beyond the cut at either end, 0 ... 995 need bins of 20, 50 of them.
TEST(RoundBins, OfAnEvenSample) {
  std::vector<double> sample;
  for (int k = 1000; k >= -5; --k) sample.push_back(k);
  const Bins bins = round_bins(sample);
  EXPECT_EQ(bins.low, 0);
  EXPECT_EQ(bins.width, 20);
  EXPECT_EQ(bins.number, 50u);
  const auto count = count_in(bins, sample);
  ASSERT_EQ(count.size(), 52u);
  EXPECT_EQ(count.front(), 5u);  // -5 ... -1
  for (std::size_t b = 1; b <= 50; ++b) EXPECT_EQ(count[b], 20u);
  EXPECT_EQ(count.back(), 1u);  // 1000
}

// Whatever the sample: at most 60 bins, all values counted, nothing below the cut left out.
TEST(RoundBins, OfOddSamples) {
  for (const std::vector<double>& sample :
       {std::vector<double>{}, {0}, {0, 0, 0}, {-7e6}, {-1e9, 3, 4e12}, {1e-300, 2e-300}, {1e6, 1e6 + 1e-9}}) {
    const Bins bins = round_bins(sample);
    EXPECT_GE(bins.number, 1u);
    EXPECT_LE(bins.number, 60u);
    EXPECT_GT(bins.width, 0);
    const auto count = count_in(bins, sample);
    std::size_t inside = 0;
    for (std::size_t b = 1; b <= bins.number; ++b) inside += count[b];
    EXPECT_EQ(inside, sample.size());
  }
}
