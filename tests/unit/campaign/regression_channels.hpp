#pragma once
/// Recordings of a regression run made from samples, as a characterisation without fits would store them.
#include "core/campaign/regression/recordings.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "core/variance/variance_intervals.hpp"

#include <span>
#include <string>
#include <utility>

namespace driftlab::regression {

inline ComparedChannel channel_of(std::span<const double> x, double dt_s, const std::string& quantity,
                                  const std::string& axis, const std::string& unit) {
  ComparedChannel channel;
  const HaarVariance curve = haar_variance(x, summarise(x)->mean);
  HaarCovariance plan(curve.half, curve.samples, dt_s);
  const VarianceIntervals intervals = variance_intervals(curve, plan, difference_excess_kurtosis(x));
  ReportedChannel& result = channel.result;
  result.quantity = quantity;
  result.axis = axis;
  result.unit = unit;
  result.samples = x.size();
  result.dt_s = dt_s;
  result.contamination = "clean";
  result.haar.variance = curve.variance;
  result.haar.edf = intervals.edf;
  for (const std::size_t half : curve.half) {
    result.haar.scale.push_back(2 * half);
  }
  channel.facts.samples = x.size();
  return channel;
}

inline ComparedRecording recording_of(const std::string& id, std::vector<ComparedChannel> channels) {
  ComparedRecording recording;
  recording.id = id;
  recording.condition = "static";
  recording.samples = channels.front().result.samples;
  recording.rate_hz = 1.0 / channels.front().result.dt_s;
  recording.declared_hz = recording.rate_hz;
  recording.duration_s = static_cast<double>(recording.samples) / recording.rate_hz;
  recording.channels = std::move(channels);
  return recording;
}

}  // namespace driftlab::regression
