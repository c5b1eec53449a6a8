#pragma once
/// A study in numbers: recordings on their time grids, the inputs that acted on each, and the error of every examined
/// channel (spec/study.md). Everything is SI; only `Channel::rows` keeps the file's own numbers, for its lattice.
#include "core/investigate/study/series.hpp"
#include "core/process/model.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/result.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// One sensor column of one recording. Grid series span the whole file, before trims; a grid place without a sample
/// has `valid` 0 and holds an interpolated value. Where every row has its place they read the file's column, which must
/// outlive them.
struct Channel {
  std::string column;
  ColumnRole role;
  Unit unit;
  std::span<const double> rows;  ///< as in the file, in `unit`; the caller's memory
  Series measured;               ///< grid, SI
  Series error;                  ///< grid, measured minus reference, SI; empty where there is no reference
  Series reference;              ///< grid, SI; empty where it is constant
  Presence valid;                ///< grid
  bool input_only = false;       ///< drives effects of other channels; not criticised itself

  /// Measured minus reference; as measured where there is none.
  [[nodiscard]] Series against_reference() const { return reference.empty() ? measured : measured.minus(reference); }
};

/// Samples that arrive several at a time: time_grid.hpp says when.
struct Bursts {
  std::size_t count = 0;   ///< bursts; 0: samples arrive one by one
  double mean = 0.0;       ///< samples in one
  double deviation = 0.0;  ///< of their numbers
};

/// What the time column says.
struct Stamps {
  bool present = false;
  std::size_t missing = 0;    ///< grid places without a sample, first to last sample
  double scatter_s = 0.0;     ///< standard deviation of the stamps about the grid, their own resolution taken off
  double resolution_s = 0.0;  ///< step of the stamps themselves; 0: finer than can be seen
  std::size_t repeated = 0;   ///< stamps equal to the one before
  Bursts bursts;
};

/// What a reference adds to the error of the channel that is compared with it.
struct ReferenceNoise {
  double density_ratio = 0.0;  ///< of its white noise over that of the sensor
  bool coarse = false;         ///< rounded until the error of single samples is not the sensor's
};

/// One recording. Series over the grid of the whole file; empty where the quantity is not known.
struct StudyRecording {
  std::string id;
  Condition condition;
  double dt_s = 0.0;
  std::size_t length = 0;  ///< grid places of the file
  std::size_t begin = 0;   ///< analysed part [begin, end)
  std::size_t end = 0;
  Stamps stamps;
  std::array<Series, 3> rate;                     ///< reference angular rate about x, y, z [rad/s]
  std::array<Series, 3> acceleration;             ///< its derivative [rad/s^2]
  std::array<Series, 3> force;                    ///< measured specific force [m/s^2]
  Series temperature;                             ///< [K]
  Series angle;                                   ///< integral of the rate about the rotation axis [rad]
  std::array<ReferenceNoise, 3> reference_noise;  ///< of `rate`
  std::vector<Channel> channels;
  std::vector<std::string> notes;
  /// What channels read where rows of the file are left out (sound_columns.hpp); null: they read the file's columns.
  std::shared_ptr<const std::vector<std::vector<double>>> memory;

  [[nodiscard]] bool is_static() const { return condition.kind == ConditionKind::Static; }
  [[nodiscard]] std::size_t count() const { return end - begin; }
  [[nodiscard]] double time_s(std::size_t i) const { return static_cast<double>(i) * dt_s; }
};

/// An effect that a given model holds besides its processes: a cause with its parameters.
struct GivenEffect {
  std::string cause;
  std::vector<std::string> channels;    ///< columns; empty: all of the model's quantity
  std::vector<std::string> recordings;  ///< ids; empty: all
  std::vector<double> values;           ///< SI, as `inject` takes them (core/investigate/causes/draft.hpp)
};

/// What a profile without a name is of, and what it goes with (unnamed_effect.hpp).
enum class UnnamedKind { Spectrum, Variance, Mean };
enum class Against { Frequency, Time, Phase, Rate, RateChange, Temperature, Warming, Angle };

/// An effect that a model holds and nobody has a name for: a measured profile, `value[k]` between `edge[k]` and
/// `edge[k + 1]`.
struct UnnamedEffect {
  UnnamedKind kind = UnnamedKind::Spectrum;
  Against against = Against::Frequency;
  std::string column;
  std::vector<std::string> recordings;  ///< ids; empty: all
  double period_s = 0.0;                ///< of a phase
  std::vector<double> edge;             ///< ascending, one more than values [SI]
  std::vector<double> value;            ///< ratios; of a mean [SI]
};

/// A simulation model: the one that is criticised, or the one that is simulated.
struct Baseline {
  bool automatic = true;
  Model processes;  ///< given baselines only
  Quantity quantity = Quantity::AngularRate;
  std::vector<std::string> channels;                    ///< columns it applies to; empty: all of its quantity
  std::map<std::string, Model> by_channel;              ///< where columns have processes of their own
  std::map<std::string, Quantity> quantity_by_channel;  ///< of what these are
  std::map<std::string, double> drift;                  ///< by column [SI/s]
  std::map<std::string, double> bias;                   ///< by column [SI]; for simulations
  std::vector<GivenEffect> effects;
  std::vector<UnnamedEffect> unnamed;
};

struct Study {
  std::string id;
  std::string device;
  std::vector<StudyRecording> recordings;
  Baseline baseline;
  std::vector<std::string> notes;
};

/// The recording of `spec` from its decoded columns, which must outlive it. The time column rules: samples are put on
/// the grid that fits its stamps best, and what they say beside that is kept in `stamps`. A row that lacks a sample of
/// one sensor has none of any (sound_columns.hpp), and a note says so.
/// Errors: those of assign_roles and RecordingColumns::use_of; NonMonotonicTime, InconsistentSampling, TooFewSamples.
[[nodiscard]] Result<StudyRecording> make_study_recording(
    const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
    const std::function<std::span<const double>(std::size_t)>& column);

/// Settles which channels are criticised (spec/causes.md, conventions): specific force beside a gyro is an input unless
/// it has a reference of its own. Call once all recordings are there.
void settle_channels(Study& study);

/// 0, 1, 2 for x, y, z; nothing for another label.
[[nodiscard]] std::optional<std::size_t> axis_index(std::string_view axis);

/// A channel of a recording by name. A column may be called "gz [deg/s]": names are kept apart, not parted at slashes.
struct ChannelName {
  std::string recording;
  std::string column;

  [[nodiscard]] std::string text() const { return recording + "/" + column; }
};

/// "recording/column" of each.
[[nodiscard]] std::vector<std::string> texts_of(const std::vector<ChannelName>& names);

/// One channel through all recordings that hold it: the unit that one base model describes.
struct ChannelGroup {
  std::string column;
  ColumnRole role;
  Unit unit;
  struct Member {
    const StudyRecording* recording = nullptr;
    const Channel* channel = nullptr;
    [[nodiscard]] ChannelName channel_name() const { return {recording->id, channel->column}; }
    [[nodiscard]] std::string name() const { return channel_name().text(); }
  };
  std::vector<Member> members;

  [[nodiscard]] std::size_t axis() const { return axis_index(role.axis).value_or(2); }
};

/// Density of what the reference's own noise adds to the error of a channel, over that of the sensor's white noise.
[[nodiscard]] double noise_of_reference(const ChannelGroup::Member& member);

/// The error of single samples is that of a coarse reference.
[[nodiscard]] bool beside_coarse_reference(const ChannelGroup::Member& member);

/// Every criticised channel once, in the order of first appearance.
[[nodiscard]] std::vector<ChannelGroup> group_channels(const Study& study);

}  // namespace driftlab::investigate
