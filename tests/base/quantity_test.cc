#include "base/quantity.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>

using namespace densify;

namespace {

std::string message_of(std::string_view text, Dimension expected) {
  try {
    parse_quantity(text, expected);
  } catch (const QuantityError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

// Prefixes and powers shift the decimal exponent, so the result is the correctly rounded SI number: exact comparison.
TEST(Quantity, PowersOfTenAreExact) {
  EXPECT_EQ(parse_quantity("30 MPa", dim::pressure), 30e6);
  EXPECT_EQ(parse_quantity("4.86 um", dim::length), 4.86e-6);
  EXPECT_EQ(parse_quantity("4.86 \xC2\xB5m", dim::length), 4.86e-6);
  EXPECT_EQ(parse_quantity("4.86\xCE\xBCm", dim::length), 4.86e-6);
  EXPECT_EQ(parse_quantity("1.72 J/m^2", dim::surface_energy), 1.72);
  EXPECT_EQ(parse_quantity("2.55e-5 m^2/s", dim::diffusivity), 2.55e-5);
  EXPECT_EQ(parse_quantity("185 kJ/mol", dim::molar_energy), 185e3);
  EXPECT_EQ(parse_quantity("7e5 N/m", dim::stiffness), 7e5);
  EXPECT_EQ(parse_quantity("1e12 N s/m", dim::viscosity_contact), 1e12);
  EXPECT_EQ(parse_quantity("1E+12 N*s/m", dim::viscosity_contact), 1e12);
  EXPECT_EQ(parse_quantity("3.832e-19 m^3/s", dim::volume_rate), 3.832e-19);
  EXPECT_EQ(parse_quantity("11.5e-6 1/K", dim::thermal_expansion), 11.5e-6);
  EXPECT_EQ(parse_quantity("5910 kg/m^3", dim::density), 5910.0);
  EXPECT_EQ(parse_quantity("5.25 g/cm^3", dim::density), 5250.0);
  EXPECT_EQ(parse_quantity("-0.005 1/s", dim::rate), -0.005);
  EXPECT_EQ(parse_quantity("-0.005 s^-1", dim::rate), -0.005);
  EXPECT_EQ(parse_quantity("12 um\xC2\xB2", dim::area), 12e-12);
  EXPECT_EQ(parse_quantity("1 kg m/(s s)", dim::force), 1.0);
  EXPECT_EQ(parse_quantity("0.1 %", dim::none), 0.001);
  EXPECT_EQ(parse_quantity(" +.5 ", dim::none), 0.5);
}

// Units of time and angle that are no powers of ten.
TEST(Quantity, MinutesHoursDegrees) {
  EXPECT_EQ(parse_quantity("33 min", dim::time), 1980.0);
  EXPECT_EQ(parse_quantity("2 h", dim::time), 7200.0);
  EXPECT_EQ(parse_quantity("1 d", dim::time), 86400.0);
  EXPECT_EQ(parse_quantity("15 K/min", dim::temperature_rate), 0.25);
  EXPECT_DOUBLE_EQ(parse_quantity("147 deg", dim::angle), 147.0 * std::numbers::pi / 180.0);
}

// degC alone is a point of the scale; in a compound it is a difference.
TEST(Quantity, CelsiusHasAnOffsetOnlyAlone) {
  EXPECT_DOUBLE_EQ(parse_quantity("1400 degC", dim::temperature), 1673.15);
  EXPECT_DOUBLE_EQ(parse_quantity("1400 \xC2\xB0"
                                  "C",
                                  dim::temperature),
                   1673.15);
  EXPECT_EQ(parse_quantity("15 degC/min", dim::temperature_rate), 0.25);
  EXPECT_EQ(parse_quantity("50 K", dim::temperature_difference), 50.0);
  EXPECT_EQ(message_of("50 degC", dim::temperature_difference),
            "\"50 degC\": a temperature difference is due, and degC counts from 0 degC; write it in K");
}

TEST(Quantity, MissingUnitShowsTheSpelling) {
  EXPECT_EQ(message_of("30", dim::pressure), "\"30\": unit missing; a pressure is due, such as \"30 MPa\"");
  EXPECT_EQ(message_of("147", dim::angle), "\"147\": unit missing; an angle is due, such as \"147 deg\"");
}

TEST(Quantity, UnknownUnitSuggestsTheNearest) {
  EXPECT_EQ(message_of("30 mPaa", dim::pressure), "\"30 mPaa\": unknown unit \"mPaa\"; did you mean \"mPa\"?");
  EXPECT_EQ(message_of("30 Mpa", dim::pressure), "\"30 Mpa\": unknown unit \"Mpa\"; did you mean \"MPa\"?");
  EXPECT_EQ(message_of("3 furlong", dim::length), "\"3 furlong\": unknown unit \"furlong\"");
  EXPECT_EQ(message_of("3 m2", dim::area), "\"3 m2\": unknown unit \"m2\"; powers are written with ^, as in \"m^2\"");
}

TEST(Quantity, WrongDimensionNamesBoth) {
  EXPECT_EQ(message_of("4.86 um", dim::pressure), "\"4.86 um\": expected pressure such as \"30 MPa\", got length");
  EXPECT_EQ(message_of("1 N/m", dim::pressure),
            "\"1 N/m\": expected pressure such as \"30 MPa\", got stiffness or surface energy");
  EXPECT_EQ(message_of("1 W", dim::time), "\"1 W\": expected time such as \"33 min\", got quantity in kg m^2/s^3");
}

TEST(Quantity, NumberMustBeFiniteAndThere) {
  for (const char* text : {"", "MPa", "nan MPa", "inf MPa", "- MPa", ". MPa", "1e99999999999 MPa"}) {
    EXPECT_NE(message_of(text, dim::pressure).find("no number found; write a pressure such as \"30 MPa\""),
              std::string::npos)
        << text;
  }
  EXPECT_NE(message_of("1e999 MPa", dim::pressure).find("does not fit"), std::string::npos);
}

TEST(Quantity, BrokenUnitExpressions) {
  for (const char* text : {"1 m^", "1 m^0.5", "1 m^99", "1 N//m", "1 (m", "1 m)", "1 /",
                           "1 m^9 m^9 m^9 m^9 m^9 m^9 m^9 m^9 m^9 m^9 m^9 m^9"}) {
    EXPECT_NE(message_of(text, dim::length).find("is not understood"), std::string::npos)
        << message_of(text, dim::length);
  }
}

// The effective input repeats a run bit for bit: every finite double, in every dimension, comes back as itself.
TEST(Quantity, FormatComesBackBitForBit) {
  std::mt19937_64 random(7);
  const Dimension dimensions[] = {dim::none,
                                  dim::length,
                                  dim::density,
                                  dim::temperature,
                                  dim::angle,
                                  dim::surface_energy,
                                  dim::molar_energy,
                                  dim::viscosity_contact,
                                  dim::thermal_expansion,
                                  dim::frequency,
                                  Dimension{2, 1, -3, -1},
                                  Dimension{-1, 0, -2}};
  int tried = 0;
  while (tried < 20000) {
    const double value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
    if (!std::isfinite(value)) continue;
    const Dimension dimension = dimensions[tried % std::size(dimensions)];
    const std::string text = format_quantity(value, dimension);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(parse_quantity(text, dimension)), std::bit_cast<std::uint64_t>(value))
        << text;
    ++tried;
  }
  EXPECT_EQ(format_quantity(2e-4, dim::length), "0.0002 m");
  EXPECT_TRUE(std::signbit(parse_quantity(format_quantity(-0.0, dim::length), dim::length)));
}
