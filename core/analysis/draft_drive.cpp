#include "core/analysis/draft_drive.hpp"

#include "core/signal/recording_columns.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace driftlab {
namespace {

/// A name without what stands before it in a log and without its unit: `latitude` and `deg` of `gnss_latitude (deg)`.
struct ReadName {
  std::string stream;  ///< `gnss`, `gnss2`; empty: none
  std::string word;    ///< in small letters, without blanks and underscores
  std::string unit;
};

ReadName read_name(std::string_view name) {
  ReadName read;
  if (const auto open = name.find_first_of("([");
      open != std::string_view::npos && name.find_last_of(")]") == name.size() - 1) {
    read.unit = name.substr(open + 1, name.size() - open - 2);
    name = name.substr(0, open);
  }
  if (const auto line = name.find('_'); name.starts_with("gnss") && line != std::string_view::npos) {
    read.stream = name.substr(0, line);
    name.remove_prefix(line + 1);
  }
  for (const char c : name) {
    if (c != ' ' && c != '_') {
      read.word += lower_case(c);
    }
  }
  return read;
}

/// What a column of a receiver is called by the readers of driftlab and in tables of fixes.
struct FixWord {
  std::string_view word;
  drive::Quantity quantity;
  std::string_view axis;
  std::string_view unit;  ///< where the name states none
};

constexpr std::string_view kAltitude = "altitude";  ///< above the geoid; a document knows heights alone

constexpr std::array kFixWords{FixWord{"latitude", drive::Quantity::GnssPosition, "lat", "deg"},
                               FixWord{"lat", drive::Quantity::GnssPosition, "lat", "deg"},
                               FixWord{"longitude", drive::Quantity::GnssPosition, "lon", "deg"},
                               FixWord{"lon", drive::Quantity::GnssPosition, "lon", "deg"},
                               FixWord{"lng", drive::Quantity::GnssPosition, "lon", "deg"},
                               FixWord{"height", drive::Quantity::GnssPosition, "height", "m"},
                               FixWord{"altitude", drive::Quantity::GnssPosition, kAltitude, "m"},
                               FixWord{"hmsl", drive::Quantity::GnssPosition, kAltitude, "m"},
                               FixWord{"alt", drive::Quantity::GnssPosition, kAltitude, "m"},
                               FixWord{"velocitynorth", drive::Quantity::GnssVelocity, "north", "m/s"},
                               FixWord{"veln", drive::Quantity::GnssVelocity, "north", "m/s"},
                               FixWord{"vn", drive::Quantity::GnssVelocity, "north", "m/s"},
                               FixWord{"velocityeast", drive::Quantity::GnssVelocity, "east", "m/s"},
                               FixWord{"vele", drive::Quantity::GnssVelocity, "east", "m/s"},
                               FixWord{"ve", drive::Quantity::GnssVelocity, "east", "m/s"},
                               FixWord{"velocitydown", drive::Quantity::GnssVelocity, "down", "m/s"},
                               FixWord{"veld", drive::Quantity::GnssVelocity, "down", "m/s"},
                               FixWord{"vd", drive::Quantity::GnssVelocity, "down", "m/s"},
                               FixWord{"vu", drive::Quantity::GnssVelocity, "up", "m/s"},
                               FixWord{"speed", drive::Quantity::GnssSpeed, "", "m/s"},
                               FixWord{"gspeed", drive::Quantity::GnssSpeed, "", "m/s"},
                               FixWord{"course", drive::Quantity::GnssCourse, "", "deg"},
                               FixWord{"headmot", drive::Quantity::GnssCourse, "", "deg"},
                               FixWord{"sdnorth", drive::Quantity::GnssAccuracy, "north", "m"},
                               FixWord{"sdn", drive::Quantity::GnssAccuracy, "north", "m"},
                               FixWord{"sdeast", drive::Quantity::GnssAccuracy, "east", "m"},
                               FixWord{"sde", drive::Quantity::GnssAccuracy, "east", "m"},
                               FixWord{"sdup", drive::Quantity::GnssAccuracy, "down", "m"},
                               FixWord{"sdu", drive::Quantity::GnssAccuracy, "down", "m"},
                               FixWord{"sdhorizontal", drive::Quantity::GnssAccuracy, "horizontal", "m"},
                               FixWord{"hacc", drive::Quantity::GnssAccuracy, "horizontal", "m"},
                               FixWord{"sdvertical", drive::Quantity::GnssAccuracy, "vertical", "m"},
                               FixWord{"vacc", drive::Quantity::GnssAccuracy, "vertical", "m"},
                               FixWord{"sdspeed", drive::Quantity::GnssAccuracy, "speed", "m/s"},
                               FixWord{"sacc", drive::Quantity::GnssAccuracy, "speed", "m/s"},
                               FixWord{"fixtype", drive::Quantity::FixType, "", ""},
                               FixWord{"q", drive::Quantity::FixType, "", ""},
                               FixWord{"quality", drive::Quantity::FixType, "", ""},
                               FixWord{"status", drive::Quantity::FixType, "", ""},
                               FixWord{"satellites", drive::Quantity::Satellites, "", ""},
                               FixWord{"numsv", drive::Quantity::Satellites, "", ""},
                               FixWord{"ns", drive::Quantity::Satellites, "", ""}};

const DraftColumn* find(const DraftSource& source, drive::Quantity quantity, std::string_view axis) {
  const auto found = std::find_if(source.columns.begin(), source.columns.end(), [&](const DraftColumn& column) {
    return column.quantity == quantity && column.axis == axis;
  });
  return found == source.columns.end() ? nullptr : &*found;
}

Error no_column(const std::string& file, const std::string& what) {
  return {ErrorCode::UnknownColumn,
          "No column of " + file + " is " + what + " by its name; write the document by hand, or rename the column.",
          {{"file", file}}};
}

Result<DraftSource> unit_of(const DraftFile& file) {
  const auto roles = assign_roles(file.spec, file.names);
  if (!roles) {
    return fail(roles.error());
  }
  DraftSource source{file.file, {}, "", "s", drive::TimeScale::Boot, std::nullopt};
  for (std::size_t i = 0; i < file.names.size(); ++i) {
    const std::optional<ColumnRole>& role = (*roles)[i];
    if (!role || !read_name(file.names[i]).stream.empty()) {
      continue;
    }
    const bool rate = role->quantity == Quantity::AngularRate;
    const bool force = role->quantity == Quantity::SpecificForce;
    if (role->quantity == Quantity::Time && source.time_column.empty()) {
      source.time_column = file.names[i];
      source.time_unit = role->unit ? role->unit->symbol : "s";
    } else if ((rate || force) && axis_index(role->axis)) {
      DraftColumn column{file.names[i], rate ? drive::Quantity::AngularRate : drive::Quantity::SpecificForce,
                         role->axis,
                         role->unit ? role->unit->symbol
                         : rate     ? "rad/s"
                                    : "m/s^2"};
      if (find(source, column.quantity, column.axis) == nullptr) {
        source.columns.push_back(std::move(column));
      }
    }
  }
  for (const drive::Quantity quantity : {drive::Quantity::AngularRate, drive::Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      if (find(source, quantity, axis) == nullptr) {
        const std::string what = quantity == drive::Quantity::AngularRate ? "the angular rate" : "the specific force";
        return fail(no_column(file.file, what + " along " + axis));
      }
    }
  }
  if (source.time_column.empty()) {
    if (!file.spec.rate_hz) {
      return fail(ErrorCode::InvalidArgument, file.file + " has no column of times: state the rate of its rows.",
                  {{"parameter", "rate_hz"}});
    }
    source.scale = drive::TimeScale::Row;
    source.rate_hz = file.spec.rate_hz;
  }
  return source;
}

/// The scale of a receiver's file by its format: what the readers of fixes say of their times.
drive::TimeScale scale_of(const DraftFile& file) {
  // A u-blox log without NAV-PVT is read by its NMEA sentences, whose times are UTC.
  const bool sentences = std::find(file.names.begin(), file.names.end(), "hdop") != file.names.end();
  return file.format == "nmea" || (file.format == "ubx" && sentences) ? drive::TimeScale::Utc
         : file.format == "rtklib_pos" || file.format == "ubx"        ? drive::TimeScale::Gps
                                                                      : drive::TimeScale::Boot;
}

/// Takes the altitude for the height where there is no height, and leaves it out where there is. True: it was taken.
bool take_altitude_for_height(DraftSource& source) {
  const bool none = find(source, drive::Quantity::GnssPosition, "height") == nullptr;
  const auto altitude = std::find_if(source.columns.begin(), source.columns.end(),
                                     [](const DraftColumn& column) { return column.axis == kAltitude; });
  if (altitude == source.columns.end()) {
    return false;
  }
  if (none) {
    altitude->axis = "height";
  } else {
    source.columns.erase(altitude);
  }
  return none;
}

/// The first stream of fixes among the columns; `beside`: the unit's own columns stand among them. A table in which no
/// column names a stream holds fixes in the rows of the unit, and at their times.
Result<DraftSource> receiver_of(const DraftFile& file, bool beside, DriveDraft& draft) {
  DraftSource source{file.file, {}, "", "s", beside ? drive::TimeScale::Boot : scale_of(file), std::nullopt};
  const auto roles = assign_roles(file.spec, file.names);
  if (!roles) {
    return fail(roles.error());
  }
  const bool one_table = beside && std::none_of(file.names.begin(), file.names.end(), [](const std::string& name) {
                           return !read_name(name).stream.empty();
                         });
  std::string stream;
  for (std::size_t i = 0; i < file.names.size(); ++i) {
    const std::string& name = file.names[i];
    const ReadName read = read_name(name);
    if (beside && !one_table && read.stream.empty()) {
      continue;
    }
    stream = stream.empty() ? read.stream : stream;
    if (read.stream != stream) {
      draft.notes.push_back("Fixes are those of " + stream + "; " + read.stream + " is another receiver's.");
      break;
    }
    const std::optional<ColumnRole>& role = (*roles)[i];
    const bool time = !one_table && (read.word == "time" || (!beside && role && role->quantity == Quantity::Time));
    if (time && source.time_column.empty()) {
      source.time_column = name;
      source.time_unit = role && role->unit && role->unit->dimension == Dimension::Time ? role->unit->symbol
                         : read.unit.empty()                                            ? "s"
                                                                                        : read.unit;
      continue;
    }
    const auto known =
        std::find_if(kFixWords.begin(), kFixWords.end(), [&](const FixWord& word) { return word.word == read.word; });
    if (known != kFixWords.end() && find(source, known->quantity, known->axis) == nullptr) {
      source.columns.push_back({name, known->quantity, std::string(known->axis),
                                known->unit.empty() || read.unit.empty() ? std::string(known->unit) : read.unit});
    }
  }
  draft.geoid = take_altitude_for_height(source);
  for (const auto& [axis, what] : {std::pair{"lat", "the latitude of the fixes"}, {"lon", "their longitude"}}) {
    if (find(source, drive::Quantity::GnssPosition, axis) == nullptr) {
      return fail(no_column(file.file, what));
    }
  }
  if (one_table) {
    source.time_column = draft.unit.time_column;
    source.time_unit = draft.unit.time_unit;
    source.scale = draft.unit.scale;
    source.rate_hz = draft.unit.rate_hz;
    draft.notes.emplace_back("Fixes stand in the rows of the unit: rows that repeat a fix are no new data.");
  } else if (source.time_column.empty()) {
    return fail(no_column(file.file, "the time of the fixes"));
  }
  if (find(source, drive::Quantity::GnssVelocity, "north") != nullptr) {  // what speed and course say again
    std::erase_if(source.columns, [](const DraftColumn& column) {
      return column.quantity == drive::Quantity::GnssSpeed || column.quantity == drive::Quantity::GnssCourse;
    });
  }
  return source;
}

std::string id_of(const std::string& file) {
  const auto slash = file.find_last_of("/\\");
  const std::string id = slash == std::string::npos ? file : file.substr(slash + 1);
  return id.substr(0, std::max<std::size_t>(id.find('.'), 1));
}

void write_notes(const DraftRequest& request, DriveDraft& draft) {
  if (draft.mounting_unknown) {
    draft.notes.emplace_back("The mounting is found from the drive; state mounting_deg where you know it.");
  } else {
    draft.notes.emplace_back(
        "The unit's axes are taken for the vehicle's, forward, right, down: state mounting_deg where they are not.");
  }
  draft.notes.emplace_back("The antenna is taken to be at the unit: state gnss.lever_arm_m.");
  draft.notes.emplace_back(
      "The model is that of an ordinary unit of a phone or a car; characterise a recording at rest, or give --model.");
  if (request.receiver && draft.receiver.scale != draft.unit.scale) {
    draft.notes.emplace_back("The unit's clock and that of the fixes differ: state the unit's time.scale, or a tag.");
  }
}

}  // namespace

Result<DriveDraft> draft_drive(const DraftRequest& request) {
  DriveDraft draft;
  draft.id = id_of(request.unit.file);
  draft.vehicle = request.vehicle;
  auto unit = unit_of(request.unit);
  if (!unit) {
    return fail(unit.error());
  }
  draft.unit = *std::move(unit);
  auto receiver = receiver_of(request.receiver.value_or(request.unit), !request.receiver, draft);
  if (!receiver) {
    return fail(receiver.error());
  }
  draft.receiver = *std::move(receiver);
  draft.mounting_unknown = drive::moves_along_its_nose(request.vehicle);
  write_notes(request, draft);
  return draft;
}

}  // namespace driftlab
