#include "core/investigate/simulated_campaign.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/investigate/search/simulate_channel.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace driftlab::investigate {
namespace {

constexpr double kOracle = 12.0;  ///< standard deviations

bool acts_on(const Finding& finding, const std::string& column) {
  return std::any_of(finding.channels.begin(), finding.channels.end(),
                     [&](const ChannelName& channel) { return channel.column == column; });
}

/// What a finding says, as an effect of a model.
GivenEffect effect_of(const Finding& finding, const std::string& column) {
  GivenEffect effect{std::string(finding.evidence.cause->name), {column}, {}, {}};
  for (const FoundParameter& parameter : finding.evidence.parameters) {
    effect.values.push_back(parameter.estimate.value);
  }
  const MeanEffect* const mean = finding.evidence.cause->as<MeanEffect>();
  if (mean != nullptr && !mean->shape_of_parameter.empty()) {
    effect.values.resize(1);
    effect.values.push_back(finding.evidence.shape);
  }
  for (const ChannelName& channel : finding.channels) {
    if (!finding.everywhere && channel.column == column) {
      effect.recordings.push_back(channel.recording);
    }
  }
  return effect;
}

std::vector<FoundParameter> sizes_of(const Cause& cause, const GivenEffect& effect, const Unit& unit) {
  std::vector<FoundParameter> sizes;
  const MeanEffect* const mean = cause.as<MeanEffect>();
  const bool by_shape = mean != nullptr && !mean->shape_of_parameter.empty();
  for (std::size_t k = 0; k < std::min(effect.values.size(), by_shape ? 1 : cause.parameters.size()); ++k) {
    const CauseParameter& parameter = by_shape ? amplitude_of(cause, effect.values.back()) : cause.parameters[k];
    const double value = effect.values[k];
    sizes.push_back({std::string(parameter.name), {value, {value, value}}, parameter.unit(unit)});
  }
  return sizes;
}

/// Templates of a mean effect over all members of a group that its recordings give.
double overlap(const ChannelGroup& group, const MeanEffect& a, double shape_a, const MeanEffect& b, double shape_b) {
  double sum = 0.0;
  std::vector<std::vector<double>> ta;
  std::vector<std::vector<double>> tb;
  for (const auto& member : group.members) {
    if (a.build(*member.recording, group, shape_a, ta) && b.build(*member.recording, group, shape_b, tb)) {
      for (std::size_t i = 0; i < ta[0].size(); ++i) {
        sum += ta[0][i] * tb[0][i];
      }
    }
  }
  return sum;
}

}  // namespace

SimulatedCampaign::SimulatedCampaign(const Study& study, const Report& report, const ChannelGroup& group,
                                     const std::vector<StudyRecording>& blank)
    : report_(report), column_(group.column), role_(group.role) {
  frame_.id = study.id;
  frame_.device = study.device;
  frame_.baseline = study.baseline;
  for (const auto& member : group.members) {
    StudyRecording recording = *member.recording;
    recording.channels = {*member.channel};
    frame_.recordings.push_back(std::move(recording));
  }
  frame_.recordings.insert(frame_.recordings.end(), blank.begin(), blank.end());
  for (StudyRecording& recording : frame_.recordings) {
    std::erase_if(recording.channels, [&](const Channel& channel) { return channel.column != column_; });
  }
  for (const ChannelModel& model : report.models) {
    channel_ = model.channel == column_ ? &model : channel_;
  }
  model_.automatic = false;
  model_.quantity = role_.quantity;
  if (channel_ != nullptr) {
    model_.processes = noise_processes(*channel_, channel_->beside);
    model_.bias[column_] = channel_->beside.bias;
    model_.drift[column_] = channel_->beside.drift;
  }
  for (const GivenEffect& effect : study.baseline.effects) {
    model_.effects.push_back(effect);
  }
  model_.unnamed = study.baseline.unnamed;
  for (const UnnamedFinding& found : report.unnamed) {
    model_.unnamed.push_back(found.effect);
  }
  for (const Finding& finding : report.findings) {
    if (acts_on(finding, column_) && !finding.evidence.ambiguous) {
      model_.effects.push_back(effect_of(finding, column_));
    }
  }
}

std::vector<Answer> SimulatedCampaign::answers_to(const OpenQuestion& question) const {
  const std::vector<ChannelGroup> groups = group_channels(frame_);
  const Cause* const cause = find_cause(question.cause);
  if (channel_ == nullptr || cause == nullptr || groups.empty() || cause->as<FileFact>() != nullptr ||
      cause->as<CommonNoise>() != nullptr) {
    return {};
  }
  if (cause->lacks != nullptr && !cause->lacks(frame_, groups.front()).empty()) {
    return {};
  }
  return question.rivals.empty() ? as_seen_by_an_oracle(question) : as_estimated(question);
}

std::vector<Answer> SimulatedCampaign::as_estimated(const OpenQuestion& question) const {
  std::vector<Answer> answers;
  const ChannelGroup group = group_channels(frame_).front();
  for (const Finding& finding : report_.findings) {
    if (finding.evidence.cause->name != question.cause || !acts_on(finding, column_) || !finding.evidence.ambiguous) {
      continue;
    }
    const GivenEffect own = effect_of(finding, column_);
    answers.push_back({own, sizes_of(*finding.evidence.cause, own, group.unit)});
    const MeanEffect* const mean = finding.evidence.cause->as<MeanEffect>();
    for (const Evidence& rival : finding.evidence.rivals) {
      const MeanEffect* const other = rival.cause->as<MeanEffect>();
      if (mean == nullptr || other == nullptr || mean->free_phase || other->free_phase) {
        continue;
      }
      // The size at which the rival comes nearest to the finding.
      const double shared = overlap(group, *mean, finding.evidence.shape, *other, rival.shape);
      const double norm = overlap(group, *other, rival.shape, *other, rival.shape);
      if (norm > 0.0 && shared != 0.0) {
        GivenEffect effect{std::string(rival.cause->name), {column_}, own.recordings, {own.values[0] * shared / norm}};
        if (other->shapes != nullptr || other->change_point) {
          effect.values.push_back(rival.shape);
        }
        answers.push_back({effect, sizes_of(*rival.cause, effect, group.unit)});
      }
      break;  // the nearest one
    }
    break;
  }
  return answers;
}

std::vector<Answer> SimulatedCampaign::as_seen_by_an_oracle(const OpenQuestion& question) const {
  const Cause& cause = *find_cause(question.cause);
  const ChannelGroup group = group_channels(frame_).front();
  const StudyRecording& longest =
      *std::max_element(frame_.recordings.begin(), frame_.recordings.end(),
                        [](const StudyRecording& a, const StudyRecording& b) { return a.count() < b.count(); });
  const Stage stage{frame_,
                    kOracle,
                    !frame_.baseline.automatic,
                    std::sqrt(channel_->beside.noise.white),
                    1.0 / longest.dt_s,
                    static_cast<double>(longest.count()) * longest.dt_s};
  Random random(1);
  GivenEffect effect{question.cause, {column_}, {}, {}};
  if (cause.showing.values != nullptr) {
    effect.values = cause.showing.values(stage, random);
  } else if (const MeanEffect* const mean = cause.as<MeanEffect>()) {
    const double shape = cause.showing.shape != nullptr ? cause.showing.shape(stage, random) : 0.0;
    const BlockSeries series =
        average_blocks(group, std::vector<std::vector<unsigned char>>(group.members.size()), false);
    BlockColumns columns = BlockColumns::zeros(series, 2);
    std::vector<std::vector<double>> built;
    for (std::size_t r = 0; r < group.members.size(); ++r) {
      const bool works = mean->build(*group.members[r].recording, group, shape, built);
      const std::vector<double> x = works ? average_like(series, r, built[0]) : std::vector<double>{};
      for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
        columns.rows[r][2 * b] = x.empty() ? 0.0 : x[b];
        columns.rows[r][2 * b + 1] = 1.0;
      }
    }
    const double information = solve_whitened(whiten(series, channel_->beside.noise, columns).columns).residual;
    if (!(information > 0.0)) {
      return {};
    }
    effect.values = {kOracle / std::sqrt(information)};
    if (mean->shapes != nullptr || mean->change_point) {
      effect.values.push_back(shape);
    }
  }
  const bool sized = !effect.values.empty() && std::isfinite(effect.values[0]) && effect.values[0] != 0.0;
  return sized ? std::vector<Answer>{{effect, sizes_of(cause, effect, group.unit)}} : std::vector<Answer>{};
}

SimulatedStudy SimulatedCampaign::simulate(const Answer& answer, std::uint64_t seed) const {
  SimulatedStudy simulated;
  simulated.study = frame_;
  Baseline model = model_;
  model.effects.push_back(answer.effect);
  for (std::size_t r = 0; r < simulated.study.recordings.size(); ++r) {
    StudyRecording& recording = simulated.study.recordings[r];
    Channel& channel = recording.channels.front();
    const SimulatedChannel made = simulate_channel(model, recording, column_, role_, seed + r);
    const std::size_t axis = axis_index(role_.axis).value_or(2);
    const bool turns = role_.quantity == Quantity::AngularRate && !recording.rate[axis].empty();
    std::vector<double> rows(channel.measured.size());
    std::vector<double> measured(rows.size());
    std::vector<double> errors(channel.error.size());
    // Digits far below the noise, as a file has them.
    const double finest = std::pow(
        10.0,
        std::floor(std::log10(1e-3 * std::sqrt(channel_->beside.noise.white / recording.dt_s) / channel.unit.factor)));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double truth = channel.error.empty() ? 0.0 : channel.measured[i] - channel.error[i];
      const double error = made.reading[i] - (turns ? recording.rate[axis][i] : 0.0);
      rows[i] = finest * std::round(channel.unit.from_si(truth + error) / finest);
      measured[i] = channel.unit.to_si(rows[i]);
      if (!errors.empty()) {
        errors[i] = measured[i] - truth;
      }
    }
    channel.measured = std::move(measured);
    channel.error = std::move(errors);
    simulated.memory.push_back(std::move(rows));
    channel.rows = simulated.memory.back();
  }
  return simulated;
}

}  // namespace driftlab::investigate
