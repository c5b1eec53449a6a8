#pragma once
/// One channel of a recording as a person looks at it before any model: its spectrum, how its values are distributed,
/// and how its spectrum changes with time.
///
/// What is looked at is the error series that an analysis takes (core/signal/recording_view.hpp), after calibration and
/// trims; where samples are missing inside, its longest run without a gap.
#include "core/analysis/recording_source.hpp"
#include "core/process/model.hpp"
#include "core/signal/apart_places.hpp"
#include "core/signal/robust_histogram.hpp"
#include "core/variance/binned_spectrum.hpp"
#include "core/variance/spectrogram.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// Columns, view and the run of one channel. Move-only; spans live as long as it does.
class ChannelLook {
 public:
  /// Errors: those of RecordingSource::open, view_of and apply_calibration; UnknownColumn where `column` is no sensor
  /// column of the recording.
  [[nodiscard]] static Result<ChannelLook> open(RecordingSource& source, std::string_view column);

  [[nodiscard]] const Unit& unit() const { return unit_; }
  [[nodiscard]] double dt_s() const { return dt_s_; }
  [[nodiscard]] std::size_t samples() const { return run_.size(); }
  /// Time of the first sample looked at since the first row of the file.
  [[nodiscard]] double first_s() const { return first_s_; }

  /// In the channel's own unit. Errors: TooFewSamples below 64.
  [[nodiscard]] Result<BinnedSpectrum> spectrum(FrequencyScale scale, std::size_t bins) const;
  /// Nothing where more than half of the values are equal.
  [[nodiscard]] std::optional<RobustHistogram> histogram(std::size_t bins) const;
  /// Where gross errors are (core/signal/apart_places.hpp).
  [[nodiscard]] std::vector<ApartPlace> apart() const;
  /// Density over that expected, cells x bands: of `model` where there is one, which leaves the spectrum of what the
  /// model does not explain; else the median of each band over time. Errors: TooFewSamples; InvalidArgument where a
  /// process of the model has no density.
  struct Ratio {
    Spectrogram spectrogram;  ///< its density divided by that expected
    bool of_model = false;
    /// log10 of the ratio, cell by cell.
    [[nodiscard]] std::vector<double> log10() const;
  };
  [[nodiscard]] Result<Ratio> ratio(const Model* model, std::size_t cells, std::size_t bands) const;

 private:
  ChannelLook(ColumnFile columns, RecordingView view) : columns_(std::move(columns)), view_(std::move(view)) {}

  ColumnFile columns_;
  RecordingView view_;
  Unit unit_;
  double dt_s_ = 0.0;
  double first_s_ = 0.0;
  double mean_ = 0.0;
  std::span<const double> run_;
};

}  // namespace driftlab
