// Logs of receivers alone: NMEA sentences and u-blox frames, each an epoch a row.
#include "core/signal/missing.hpp"
#include "core/signal/recording_view.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace driftlab::testing;

TEST(Nmea, PutsTheSentencesOfAMomentIntoOneRowAndGoesOnOverMidnight) {
  const Outcome outcome = decode_bytes(nmea());
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "nmea");
  ASSERT_EQ(outcome.decoded.rows, 2U);
  const double midnight = 1672531200.0;  // 2023-01-01
  EXPECT_DOUBLE_EQ(cell(outcome, 0, 0), midnight - 1.0);
  EXPECT_DOUBLE_EQ(cell(outcome, 0, 1), midnight);
  EXPECT_DOUBLE_EQ(cell(outcome, 1, 0), 48.5);
  EXPECT_DOUBLE_EQ(cell(outcome, 1, 1), -48.5);
  EXPECT_DOUBLE_EQ(cell(outcome, 2, 1), -9.25);
  EXPECT_DOUBLE_EQ(cell(outcome, 3, 0), 300.0) << "above the ellipsoid";
  EXPECT_DOUBLE_EQ(cell(outcome, 8, 0), 10.0 * 1852.0 / 3600.0);
  EXPECT_DOUBLE_EQ(cell(outcome, 10, 0), 0.011);
  EXPECT_TRUE(std::isnan(cell(outcome, 8, 1))) << "no sentence says its speed";
}

TEST(Nmea, CountsDamagedLinesAndSaysThatThereIsNoDate) {
  const std::string good = nmea_sentence("GPGGA,120000.00,4830.0000,N,00915.0000,E,4,12,0.9,250.5,M,49.5,M,,");
  std::string damaged = good;
  damaged[20] = '9';
  std::string text = damaged;
  for (int i = 0; i < 8; ++i) {
    text += nmea_sentence("GPGGA,12000" + std::to_string(i) + ".00,4830.0000,N,00915.0000,E,4,12,0.9,250.5,M,49.5,M,,");
  }
  const Outcome outcome = decode_bytes(text);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 8U);
  EXPECT_DOUBLE_EQ(cell(outcome, 0, 0), 43200.0);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("seconds of the day")));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("1 line is no sentence")));
  EXPECT_EQ(decode_bytes(nmea_sentence("GPGSV,1,1,00")).error, ErrorCode::NoSamples);
}

TEST(Nmea, DatesRowsThatCameBeforeTheDate) {
  const Outcome outcome =
      decode_bytes(nmea_sentence("GPGGA,235958.00,4830.0000,N,00915.0000,E,4,12,0.9,250.5,M,49.5,M,,") + nmea());
  ASSERT_FALSE(outcome.error) << outcome.message;
  ASSERT_EQ(outcome.decoded.rows, 3U);
  EXPECT_DOUBLE_EQ(cell(outcome, 0, 0), 1672531198.0);
}

TEST(Receiver, IsNoSensorWhoseNoiseIsCharacterised) {
  const std::string earth = "%  GPST x-ecef(m) y-ecef(m) z-ecef(m) Q ns\n";
  for (const std::string& log :
       {nmea(), ubx_pvt(3), rtklib_pos(), earth + "2374 1.0 4e6 6e5 5e6 1 9\n2374 2.0 4e6 6e5 5e6 1 9\n"}) {
    const Outcome outcome = decode_bytes(log);
    ASSERT_FALSE(outcome.error) << outcome.message;
    const auto view_of = [&](const RecordingSpec& spec, ViewUse use) {
      std::vector<std::vector<double>> columns;
      for (std::size_t c = 0; c < outcome.bits.size(); ++c) {
        columns.emplace_back();
        for (std::size_t i = 0; i < outcome.decoded.rows; ++i) {
          columns.back().push_back(cell(outcome, c, i));
        }
      }
      const auto view = view_recording(
          spec, outcome.decoded.names, outcome.decoded.rows,
          [&](std::size_t i) { return std::span<const double>(columns[i]); }, use);
      return view ? std::string() : view.error().message;
    };
    EXPECT_THAT(view_of({}, ViewUse::Analysis), HasSubstr("`driftlab drive draft")) << outcome.decoded.format;
    EXPECT_THAT(view_of({}, ViewUse::Survey), Not(HasSubstr("drive"))) << "the log of a drive is uploaded";
    RecordingSpec stated;
    stated.columns["time (s)"] = {Quantity::Time, "", *parse_unit("s")};
    stated.columns[outcome.decoded.names[1]] = {};
    EXPECT_THAT(view_of(stated, ViewUse::Analysis), Not(HasSubstr("drive"))) << "who states columns wants them";
  }
}

TEST(Ubx, ReadsNavPvtOnGpsTime) {
  const Outcome outcome = decode_bytes(ubx_pvt(3));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "ubx");
  ASSERT_EQ(outcome.decoded.rows, 3U);
  EXPECT_NEAR(cell(outcome, 0, 0), 1752003240.0 + 18.0, 1e-6);
  EXPECT_NEAR(cell(outcome, 0, 2) - cell(outcome, 0, 0), 2.0, 1e-6);
  EXPECT_EQ(cell(outcome, 1, 0), 3.0);
  EXPECT_DOUBLE_EQ(cell(outcome, 3, 0), -48.5);
  EXPECT_DOUBLE_EQ(cell(outcome, 4, 0), 9.25);
  EXPECT_DOUBLE_EQ(cell(outcome, 5, 0), 300.125);
  EXPECT_DOUBLE_EQ(cell(outcome, 9, 0), -1.25);
  EXPECT_DOUBLE_EQ(cell(outcome, 13, 0), 90.0);
}

TEST(Ubx, ReadsTheSentencesOfALogWithoutNavPvt) {
  // A receiver that writes its positions as NMEA and the rest as UBX was refused.
  const Outcome sentences = decode_bytes(nmea());
  const std::string other = ubx_frame(1, 3, std::string(16, '\x05'));
  const std::string text = nmea();
  std::string log = other;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at) + 1;
    log += text.substr(at, end - at) + other + "\xD3\x01$correction\x02";
    at = end;
  }
  for (const std::size_t piece : {std::size_t{1}, std::size_t{1} << 20}) {
    const Outcome mixed = decode_bytes(log, piece);
    ASSERT_FALSE(mixed.error) << mixed.message;
    EXPECT_EQ(mixed.decoded.format, "ubx");
    EXPECT_EQ(mixed.decoded.names, sentences.decoded.names);
    EXPECT_EQ(mixed.bits, sentences.bits);
    EXPECT_THAT(mixed.decoded.notes, Contains(HasSubstr("its NMEA sentences are read")));
  }
  const Outcome both = decode_bytes(ubx_pvt(3) + log);
  EXPECT_EQ(both.bits, decode_bytes(ubx_pvt(3)).bits) << "NAV-PVT says more than the sentences";
}

TEST(Ubx, WhatOnlyLooksLikeBeginningsOfFramesCostsNoMoreThanItsBytes) {
  // Each pair of bytes claims a frame of 25,269 bytes, whose checksum was added up: minutes for 8 MB.
  std::string log = ubx_pvt(3);
  while (log.size() < (std::size_t{8} << 20U)) {
    log += "\xB5\x62";
  }
  const Outcome outcome = decode_bytes(log + ubx_pvt(2));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 5U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("have a wrong checksum")));
}

TEST(Ubx, TakesFramesWhereverTheWindowOntoTheLogEnds) {
  std::string log = ubx_pvt(2);
  for (int i = 0; i < 40; ++i) {  // the longest frames there are, of any contents
    std::string payload(65535, static_cast<char>(i));
    payload.replace(300, 2, "\xB5\x62");
    log += ubx_frame(0x0A, 4, payload) + std::string(static_cast<std::size_t>(i), '\xB5') + ubx_pvt(1);
  }
  for (const std::size_t piece : {std::size_t{4096}, std::size_t{65537}, log.size()}) {
    const Outcome outcome = decode_bytes(log, piece);
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_EQ(outcome.decoded.rows, 42U);
    EXPECT_THAT(outcome.decoded.notes, Not(Contains(HasSubstr("checksum"))));
  }
}

TEST(Ubx, LeadsRawMeasurementsToRtklib) {
  const Outcome raw = decode_bytes(ubx_frame(2, 0x15, std::string(16, '\0')) + ubx_frame(2, 0x13, "12345678"));
  EXPECT_EQ(raw.error, ErrorCode::NoSamples);
  EXPECT_THAT(raw.message, HasSubstr("convbin, then rnx2rtkp"));
}

TEST(Ubx, SkipsDamagedFramesAndSaysWhatIsMissing) {
  std::string log = ubx_pvt(4);
  log[80] = static_cast<char>(log[80] ^ 1);  // in the first NAV-PVT
  const Outcome outcome = decode_bytes(log);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 3U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("wrong checksum")));
  const Outcome torn = decode_bytes(ubx_pvt(4).substr(0, 300));
  ASSERT_FALSE(torn.error) << torn.message;
  EXPECT_EQ(torn.decoded.rows, 2U);
  const std::string others = ubx_frame(1, 3, std::string(16, '\x05'));
  const Outcome none = decode_bytes(others + others);
  EXPECT_EQ(none.error, ErrorCode::NoSamples);
  EXPECT_THAT(none.message, HasSubstr("NAV-PVT"));
}

}  // namespace
}  // namespace driftlab
