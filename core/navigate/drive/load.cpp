#include "core/navigate/drive/drive.hpp"
#include "core/signal/channel_survey.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace driftlab::drive {
namespace {

constexpr double kLongestWithoutFixes = 10.0;  ///< [s] at the end, without a word

/// One sentence about a channel of the unit that is frozen, at full scale, or holds numbers that stand for none; empty
/// where it does not. Cells that are missing are counted by whole rows (SamplingFacts).
std::string unusual(ChannelQuality quality, std::size_t rows) {
  if (quality.implausible + quality.frozen + quality.saturated == 0) {
    return {};
  }
  quality.missing = 0;
  quality.distinct.reset();
  quality.analysed = rows;
  return describe(quality, rows);
}

/// The three axes of a sensor at the stamped rows.
Result<std::vector<Vector3>> triad_of(const Table& table, const Source& source, Quantity quantity,
                                      const StampedRows& stamped, FileFacts& facts) {
  std::vector<Vector3> values(stamped.row.size());
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    const auto found = find_unit_channel(table, source, quantity, axis);
    if (!found) {
      return fail(found.error());
    }
    if (const std::string told = unusual(found->quality, table.rows()); !told.empty()) {
      facts.notes.push_back(source.file + ": " + told);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i](k) = found->values[stamped.row[i]];
    }
  }
  return values;
}

struct Log {
  SensorLog rows;
  bool absolute = false;
};

Result<Log> sensor_log(const Document& document, const Tables& tables, FileFacts& facts) {
  const ImuSource& imu = document.imu;
  auto stamped = stamp_rows(tables.imu, imu.source.time);
  if (!stamped) {
    return fail(stamped.error());
  }
  facts.imu_stamps = stamped->facts;
  auto rate = triad_of(tables.imu, imu.source, Quantity::AngularRate, *stamped, facts);
  if (!rate) {
    return fail(rate.error());
  }
  Log log;
  log.absolute = stamped->absolute;
  if (!imu.force) {
    auto force = triad_of(tables.imu, imu.source, Quantity::SpecificForce, *stamped, facts);
    if (!force) {
      return fail(force.error());
    }
    log.rows.time_s = std::move(stamped->time_s);
    for (std::size_t i = 0; i < rate->size(); ++i) {
      const Vector3& w = (*rate)[i];
      const Vector3& f = (*force)[i];
      log.rows.readings.push_back({w.x(), w.y(), w.z(), f.x(), f.y(), f.z()});
    }
    return log;
  }
  if (!tables.force) {
    return fail(ErrorCode::InvalidArgument, "The file of the accelerometer is missing.",
                {{"parameter", "imu.force.file"}});
  }
  auto force_rows = stamp_rows(*tables.force, imu.force->time);
  if (!force_rows) {
    return fail(force_rows.error());
  }
  auto force = triad_of(*tables.force, *imu.force, Quantity::SpecificForce, *force_rows, facts);
  if (!force) {
    return fail(force.error());
  }
  log.rows = joined(stamped->time_s, *rate, force_rows->time_s, *force);
  return log;
}

void turn_into_body(std::vector<UniformRun>& runs, const Matrix3& mounting) {
  for (UniformRun& run : runs) {
    for (ImuSample& sample : run.readings) {
      const Vector3 rate = mounting * Vector3(sample[0], sample[1], sample[2]);
      const Vector3 force = mounting * Vector3(sample[3], sample[4], sample[5]);
      sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
    }
  }
}

/// Speed and length of a drive whose receiver states no velocity, from positions 5 s apart: metres of their noise are
/// then a fraction of 1 m/s.
void describe_motion_by_positions(Drive& drive) {
  constexpr double kApart = 5.0;  // [s]
  const Fix* from = &drive.fixes.front();
  for (const Fix& fix : drive.fixes) {
    if (fix.time_s - from->time_s >= kApart) {
      const Vector3 moved = ned_axes(from->position_ecef_m).transpose() * (fix.position_ecef_m - from->position_ecef_m);
      const double length = moved.head<2>().norm();
      drive.facts.length_m += length;
      drive.facts.highest_speed_m_s = std::max(drive.facts.highest_speed_m_s, length / (fix.time_s - from->time_s));
      from = &fix;
    }
  }
}

void describe_motion(Drive& drive) {
  FileFacts& facts = drive.facts;
  facts.fixes = drive.fixes.size();
  facts.fix_rate_hz =
      static_cast<double>(drive.fixes.size() - 1) / (drive.fixes.back().time_s - drive.fixes.front().time_s);
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    const Fix& fix = drive.fixes[i];
    if (fix.velocity_ned_m_s) {
      facts.highest_speed_m_s = std::max(facts.highest_speed_m_s, fix.velocity_ned_m_s->head<2>().norm());
      if (i > 0) {
        const double step = std::min(fix.time_s - drive.fixes[i - 1].time_s, 2.0);
        facts.length_m += fix.velocity_ned_m_s->head<2>().norm() * step;
      }
    }
  }
  if (!drive.has_velocities()) {
    describe_motion_by_positions(drive);
  }
}

/// What decoding said of the files, such as an end in the middle of a row; once of a file that holds several sources.
void write_notes_of_decoding(const Document& document, const Tables& tables, std::vector<std::string>& notes) {
  std::vector<std::string> told;
  const auto add = [&](const char* what, const Source& source, const Table& table) {
    if (std::find(told.begin(), told.end(), source.file) == told.end()) {
      told.push_back(source.file);
      std::transform(table.notes.begin(), table.notes.end(), std::back_inserter(notes),
                     [&](const std::string& said) { return std::string("The file of ") + what + ": " + said; });
    }
  };
  add("the readings", document.imu.source, tables.imu);
  if (document.imu.force && tables.force) {
    add("the accelerometer", *document.imu.force, *tables.force);
  }
  add("the fixes", document.gnss.source, tables.gnss);
  if (document.reference.source && tables.reference) {
    add("the reference", *document.reference.source, *tables.reference);
  }
  if (document.odometer && tables.odometer) {
    add("the odometer", document.odometer->source, *tables.odometer);
  }
}

/// Members of the document that no filter of itself acts on.
void write_notes_on_members(Drive& drive) {
  const ImuSource& imu = drive.document.imu;
  const GnssSource& gnss = drive.document.gnss;
  std::vector<std::string>& notes = drive.facts.notes;
  if (gnss.lever_arm_sd_m > 0.0) {
    notes.emplace_back(
        "The lever arm is taken as stated: its standard deviation counts where the arm is to be estimated.");
  }
  if (imu.mounting_sd_rad > 0.0) {
    notes.emplace_back(
        "The mounting is taken as stated: its standard deviation counts where it is to be estimated under velocity "
        "constraints.");
  }
  if (imu.clock == SensorClock::Arrival || imu.source.time.arrival) {
    notes.emplace_back(
        "Readings are stamped when they arrive: between gaps they get equal spacing, and by how much all are late is "
        "part of the offset of the unit's clock.");
  }
  if (gnss.source.time.arrival) {
    notes.emplace_back(
        "Fixes are stamped when they arrive: by how much they are late is not taken off; it is the latency of the "
        "document, or part of the offset of the unit's clock.");
  }
  for (const Source* const other : {drive.document.reference.source ? &*drive.document.reference.source : nullptr,
                                    drive.document.odometer ? &drive.document.odometer->source : nullptr}) {
    if (other != nullptr && other->time.arrival) {
      notes.push_back("Rows of " + other->file + " are stamped when they arrive; nothing is taken off their time.");
    }
  }
}

std::string count_text(std::size_t count, const char* of) { return std::to_string(count) + " " + of; }

void write_notes(Drive& drive) {
  FileFacts& facts = drive.facts;
  const auto note = [&](bool true_of_it, const std::string& sentence) {
    if (true_of_it) {
      facts.notes.push_back(sentence);
    }
  };
  note(facts.accuracy_constant, "The stated accuracy of the positions never varies; it is not used.");
  note(facts.speed_accuracy_constant, "The stated accuracy of the speed never varies; it is not used.");
  note(facts.vertical_accuracy_constant, "The stated vertical accuracy never varies; it is not used.");
  note(facts.without_accuracy > 0,
       count_text(facts.without_accuracy,
                  "fixes state an accuracy that is 0 or no number; the document's stands in its place."));
  note(facts.height_zero, "Every height is 0: it is nobody's, and only horizontal results are given.");
  note(facts.course_constant, "The course of the fixes never varies: neither it nor the speed is used as a velocity.");
  note(facts.without_type > 0,
       count_text(facts.without_type, "fixes say no type; they are among those that are left out."));
  note(facts.imu_stamps.without_stamp + facts.gnss_stamps.without_stamp > 0,
       count_text(facts.imu_stamps.without_stamp + facts.gnss_stamps.without_stamp,
                  "rows have no time and are left out."));
  note(facts.reference_gaps > 0, "The reference has gaps (" + std::to_string(facts.reference_gaps) + ", " +
                                     std::to_string(std::lround(facts.reference_gaps_s)) +
                                     " s in all): outages that begin or end in one are not scored.");
  note(facts.held > 0, count_text(facts.held, "rows of the fixes repeat the fix before; they are no new data."));
  note(facts.far_away > 0,
       count_text(facts.far_away, "fixes lie more than 200 km from the middle of the drive and are left out."));
  note(facts.outside_readings > 0,
       count_text(facts.outside_readings,
                  "fixes lie before the first reading of the unit or after its last and are left out."));
  const double without_fixes = drive.end_s() - drive.fixes.back().time_s;
  note(without_fixes > kLongestWithoutFixes,
       "The fixes end " + std::to_string(std::lround(without_fixes)) + " s before the readings do.");
  note(facts.incomplete > 0, count_text(facts.incomplete, "rows of the fixes have no position and are left out."));
  note(facts.other_types > 0, count_text(facts.other_types, "fixes of other types are left out."));
  note(facts.gnss_stamps.week_rollovers + facts.imu_stamps.week_rollovers > 0,
       "The seconds of the week start again within the drive; time goes on.");
  note(facts.gnss_stamps.leap_seconds > 0.0 || facts.imu_stamps.leap_seconds > 0.0,
       "Leap seconds were added once to bring UTC to GPS time.");
  note(facts.gnss_stamps.leap_within || facts.imu_stamps.leap_within,
       "A leap second falls within the drive: UTC counts it, GPS time goes on.");
  note(facts.imu_stamps.backward + facts.gnss_stamps.backward > 0,
       count_text(facts.imu_stamps.backward + facts.gnss_stamps.backward, "rows whose stamp steps back are left out."));
  note(facts.sampling.incomplete > 0,
       count_text(facts.sampling.incomplete, "rows of the unit are incomplete and are left out."));
  note(
      facts.sampling.repeated_stamps > 0,
      count_text(facts.sampling.repeated_stamps, "rows of the unit have the time of the row before and are left out."));
  note(facts.sampling.stuck > 0,
       count_text(facts.sampling.stuck, "rows of the unit stand in runs of equal rows: the sensor was stuck there."));
  note(facts.sampling.gaps_splitting > 0,
       count_text(facts.sampling.gaps_splitting, "gaps are too long to bridge; the filter begins anew after each."));
  write_notes_on_members(drive);
  note(drive.document.gnss.geoid, "Heights are above the geoid: only horizontal results are given.");
  note(drive.withheld_fixes,
       "The reference is the withheld fixes: their own errors are part of every error given here.");
  note(facts.highest_speed_m_s < 3.0,
       "The vehicle never moves faster than 3 m/s: its heading cannot be observed from its course.");
  note(!drive.has_velocities(), "No fix has a velocity: the heading at the start cannot be observed from a course.");
}

Status load_reference(const Document& document, const Tables& tables, double epoch_s, bool absolute, Drive& drive) {
  if (!document.reference.source) {
    drive.withheld_fixes = true;
    for (const Fix& fix : drive.fixes) {
      drive.reference.push_back({fix.time_s, fix.position_ecef_m});
    }
    return {};
  }
  if (!tables.reference) {
    return fail(ErrorCode::InvalidArgument, "The reference's file is missing.", {{"parameter", "reference.file"}});
  }
  auto stamped = stamp_rows(*tables.reference, document.reference.source->time);
  if (!stamped) {
    return fail(stamped.error());
  }
  if (stamped->absolute != absolute) {
    return fail(ErrorCode::InconsistentSampling, "The reference has another clock than the inertial unit.");
  }
  GnssSource as_fixes;  // a reference is read as fixes are: positions of an antenna, or of the unit itself
  as_fixes.source = *document.reference.source;
  for (auto& [name, meaning] : as_fixes.source.columns) {
    meaning.quantity = meaning.quantity == Quantity::ReferencePosition   ? Quantity::GnssPosition
                       : meaning.quantity == Quantity::ReferenceVelocity ? Quantity::GnssVelocity
                                                                         : Quantity::Ignored;
  }
  FileFacts of_reference;
  auto points = fixes_of(as_fixes, *tables.reference, *stamped, of_reference);
  if (!points) {
    return fail(points.error());
  }
  std::size_t equal = 0;
  for (const Fix& point : *points) {
    drive.reference.push_back({point.time_s - epoch_s, point.position_ecef_m});
  }
  for (std::size_t i = 1; i < drive.reference.size(); ++i) {
    const double step = drive.reference[i].time_s - drive.reference[i - 1].time_s;
    if (step > 2.0 * kNearestReference) {
      ++drive.facts.reference_gaps;
      drive.facts.reference_gaps_s += step;
    }
  }
  std::size_t at = 0;
  for (const Fix& fix : drive.fixes) {
    while (at + 1 < drive.reference.size() && drive.reference[at].time_s < fix.time_s - 1e-3) {
      ++at;
    }
    equal += (drive.reference[at].position_ecef_m - fix.position_ecef_m).norm() < 1e-4 ? 1 : 0;
  }
  if (equal * 10 > drive.fixes.size() * 9) {
    drive.facts.notes.emplace_back(
        "The reference equals the fixes: it is the filter's own input, and errors are those against withheld fixes.");
    drive.withheld_fixes = true;
  }
  return {};
}

Status load_odometer(const Document& document, const Tables& tables, double epoch_s, bool absolute, Drive& drive) {
  if (!document.odometer) {
    return {};
  }
  if (!tables.odometer) {
    return fail(ErrorCode::InvalidArgument, "The odometer's file is missing.", {{"parameter", "odometer.file"}});
  }
  const OdometerSource& source = *document.odometer;
  auto stamped = stamp_rows(*tables.odometer, source.source.time);
  if (!stamped) {
    return fail(stamped.error());
  }
  if (stamped->absolute != absolute) {
    return fail(ErrorCode::InconsistentSampling, "The odometer has another clock than the inertial unit.");
  }
  const auto found_speed = find_quantity(*tables.odometer, source.source, Quantity::OdometerSpeed);
  const auto found_ticks = find_quantity(*tables.odometer, source.source, Quantity::OdometerTicks);
  if (!found_speed || !found_ticks) {
    return fail(!found_speed ? found_speed.error() : found_ticks.error());
  }
  const auto& speed = *found_speed;
  const auto& ticks = *found_ticks;
  if (!speed && !(ticks && source.metres_per_tick > 0.0)) {
    return fail(ErrorCode::InvalidArgument,
                "The odometer needs a column of odometer_speed, or odometer_ticks with metres_per_tick above 0.",
                {{"parameter", "odometer.columns"}});
  }
  for (std::size_t k = speed ? 0 : 1; k < stamped->row.size(); ++k) {
    double value = 0.0;
    double time_s = stamped->time_s[k];
    if (speed) {
      value = (*speed)[stamped->row[k]];
    } else if (ticks) {  // the mean speed between two counts belongs to the middle
      const double step = time_s - stamped->time_s[k - 1];
      value = source.metres_per_tick * ((*ticks)[stamped->row[k]] - (*ticks)[stamped->row[k - 1]]) / step;
      time_s -= 0.5 * step;
    }
    if (std::isfinite(value)) {
      drive.odometer.push_back({time_s - epoch_s, value});
    }
  }
  return {};
}

}  // namespace

Matrix3 mounting_matrix(const EulerAngles& mounting) { return from_euler(mounting).toRotationMatrix().transpose(); }

Result<Drive> load_drive(const Document& document, const Tables& tables, const LoadOptions& options) {
  if (auto status = check(document); !status) {
    return fail(status.error());
  }
  Drive drive;
  drive.document = document;
  auto log = sensor_log(document, tables, drive.facts);
  if (!log) {
    return fail(log.error());
  }
  const bool arrives = document.imu.clock == SensorClock::Sensor && document.imu.source.time.arrival;
  const SensorClock clock = arrives ? SensorClock::Arrival : document.imu.clock;
  auto runs = uniform_readings(std::move(log->rows), {clock, options.repair}, drive.facts.sampling);
  if (!runs) {
    return fail(runs.error());
  }
  drive.runs = std::move(*runs);
  auto stamped = stamp_rows(tables.gnss, document.gnss.source.time);
  if (!stamped) {
    return fail(stamped.error());
  }
  if (stamped->absolute != log->absolute) {
    return fail(ErrorCode::InconsistentSampling,
                "The unit's clock and that of the fixes have nothing in common: one counts from power-up, the other is "
                "GPS time or UTC. Give the unit's file a time tag, or stamps of one clock to both.");
  }
  drive.facts.gnss_stamps = stamped->facts;
  auto fixes = fixes_of(document.gnss, tables.gnss, *stamped, drive.facts);
  if (!fixes) {
    return fail(fixes.error());
  }
  drive.epoch_s = drive.runs.front().start_s;
  for (UniformRun& run : drive.runs) {
    run.start_s -= drive.epoch_s;
  }
  for (Fix& fix : *fixes) {
    fix.time_s -= drive.epoch_s;
  }
  const double end = drive.end_s();
  drive.facts.outside_readings =
      std::erase_if(*fixes, [&](const Fix& fix) { return fix.time_s < -1.0 || fix.time_s > end + 1.0; });
  if (fixes->size() < 4) {
    return fail(ErrorCode::InconsistentSampling,
                "Readings and fixes do not overlap in time; are their time scales and offsets right?");
  }
  drive.fixes = std::move(*fixes);
  Matrix3 mounting = mounting_matrix(document.imu.mounting);
  if (document.imu.mounting_unknown) {
    turn_into_body(drive.runs, mounting);
    auto found = found_mounting(drive.runs, drive.fixes);
    if (!found) {
      return fail(found.error());
    }
    mounting = *found;
  }
  turn_into_body(drive.runs, mounting);
  if (auto status = load_reference(document, tables, drive.epoch_s, log->absolute, drive); !status) {
    return fail(status.error());
  }
  if (auto status = load_odometer(document, tables, drive.epoch_s, log->absolute, drive); !status) {
    return fail(status.error());
  }
  describe_motion(drive);
  write_notes_of_decoding(document, tables, drive.facts.notes);
  write_notes(drive);
  if (auto status = check_plausible(drive); !status) {
    return fail(status.error());
  }
  return drive;
}

}  // namespace driftlab::drive
