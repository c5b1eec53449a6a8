/// What the injection of every registered cause puts into a recording obeys an equation that was not written with the
/// cause: a wrong sign or unit in a template would else be hidden and found again by itself. What every registered
/// cause owes its readers is asked here too.
#include "core/investigate/causes/cause.hpp"
#include "tests/hidden/equations.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <map>
#include <string>

namespace driftlab::hidden {
namespace {

using namespace investigate;

constexpr double kRateHz = 50.0;
constexpr std::size_t kSamples = 40000;

/// One recording of gyroscopes, accelerometers, reference rate and temperature through tests/hidden/equations.hpp's
/// motion, written in lab units and read as the product reads a file.
StudyRecording recording_in_motion() {
  static std::deque<std::vector<double>> memory;
  const std::size_t first = memory.size();
  RecordingSpec spec;
  spec.id = "motion";
  spec.rate_hz = kRateHz;
  spec.condition.kind = ConditionKind::Profile;
  spec.trim = {.start_s = 10.0, .end_s = 5.0};
  ColumnNames names;
  const auto add = [&](const char* name, Quantity quantity, const char* axis, const char* unit,
                       const std::function<double(double)>& si) {
    const Unit u = *parse_unit(unit);
    std::vector<double> column(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      column[i] = u.from_si(si(static_cast<double>(i) / kRateHz));
    }
    names.emplace_back(name);
    spec.columns[name] = {quantity, axis, u};
    memory.push_back(std::move(column));
  };
  const auto nothing = [](double) { return 0.0; };
  add("t", Quantity::Time, "", "s", [](double t) { return t; });
  add("gx", Quantity::AngularRate, "x", "deg/s", nothing);
  add("gz", Quantity::AngularRate, "z", "deg/s", motion::rate);
  add("fx", Quantity::SpecificForce, "x", "m/s^2", nothing);
  add("fy", Quantity::SpecificForce, "y", "m/s^2", nothing);
  add("fz", Quantity::SpecificForce, "z", "m/s^2", motion::force);
  add("rz", Quantity::ReferenceAngularRate, "z", "deg/s", motion::rate);
  add("temp", Quantity::Temperature, "", "degC", motion::temperature);
  auto recording = make_study_recording(spec, names, kSamples,
                                        [&](std::size_t i) { return std::span<const double>(memory[first + i]); });
  EXPECT_TRUE(recording);
  if (recording) {
    recording->condition.heading_deg = motion::kHeadingDeg;
  }
  return recording ? std::move(*recording) : StudyRecording{};
}

struct Place {
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
};

/// The channels that a cause is put on where it is shown.
std::vector<Place> channels_of(const Cause& cause) {
  if (cause.showing.scenario == Scenario::Turning) {
    return {{Quantity::SpecificForce, "x"}, {Quantity::SpecificForce, "y"}};
  }
  return {{Quantity::AngularRate, cause.showing.axis.empty() ? "z" : std::string(cause.showing.axis)}};
}

/// White noise, a slow part that no seed draws, and a bias.
Draft blank_draft(StudyRecording& recording, const ChannelGroup& group, std::uint64_t stream) {
  Draft draft;
  draft.recording = &recording;
  draft.group = &group;
  Random noise(11, stream);
  Random common(11, 99);
  for (std::size_t i = 0; i < kSamples; ++i) {
    draft.white.push_back(0.01 * noise.normal());
    draft.slow.push_back(0.02 * std::sin(0.001 * static_cast<double>(i)));
    draft.mean.push_back(0.01);
    draft.shared.push_back(common.normal());
  }
  return draft;
}

using Check = std::function<std::vector<Figure>(const Injected&)>;

/// A law, and values of the parameters at which it is looked at.
struct Trial {
  std::vector<double> values;
  Check figures;
};

std::vector<Trial> trials_of(const Cause& cause) {
  std::vector<Trial> trials;
  for (const Equation& equation : equations()) {
    if (equation.cause == cause.name) {
      trials.push_back({equation.values, equation.figures});
    }
  }
  if (trials.empty() && cause.showing.law != nullptr) {
    trials.push_back({make_case(std::string(cause.name), 30.0, 1).effect.values, [&](const Injected& injected) {
                        return cause.showing.law(injected.before, injected.after, injected.values);
                      }});
  }
  return trials;
}

bool holds(const Figure& figure) { return std::fabs(figure.seen - figure.expected) <= figure.tolerance; }

bool all_hold(const std::vector<Figure>& figures) {
  return !figures.empty() && std::all_of(figures.begin(), figures.end(), holds);
}

/// What was injected, told to the law as if it had been `values`.
std::vector<Figure> as_if(const Trial& trial, const Injected& injected, const std::vector<double>& values) {
  return trial.figures({injected.before, injected.after, injected.other, values, injected.again});
}

/// A law that half or twice of a parameter passes as well, or the negative of a mean effect, proves nothing.
void expect_sharp(const Cause& cause, const Trial& trial, const Injected& injected) {
  const MeanEffect* const mean = cause.as<MeanEffect>();
  const bool by_shape = mean != nullptr && !mean->shape_of_parameter.empty();
  const std::size_t reported = by_shape ? 1 : std::min(cause.parameters.size(), trial.values.size());
  for (std::size_t k = 0; k < reported; ++k) {
    for (const double factor : {0.5, 2.0}) {
      std::vector<double> values = trial.values;
      values[k] *= factor;
      EXPECT_FALSE(all_hold(as_if(trial, injected, values)))
          << cause.parameters[k].name << " times " << factor << " would pass";
    }
  }
  if (mean != nullptr && !mean->free_phase) {
    std::vector<double> values = trial.values;
    values[0] = -values[0];
    EXPECT_FALSE(all_hold(as_if(trial, injected, values))) << "the negative would pass";
  }
}

std::vector<std::string> cause_names() {
  std::vector<std::string> names;
  for (const Cause& cause : cause_registry()) {
    names.emplace_back(cause.name);
  }
  return names;
}

/// Whether the cause is noise of another colour, or of the mean, which a level or tails of the white noise beside it
/// must leave alone: they stand in the place of the white part.
bool stands_beside_white_noise(const Cause& cause) {
  return cause.is_slow() || cause.as<SpectralPeak>() != nullptr || cause.as<DifferencedNoise>() != nullptr ||
         cause.as<SpectralLine>() != nullptr || cause.as<SwitchingNoise>() != nullptr;
}

class CauseLaw : public testing::TestWithParam<std::string> {};

TEST_P(CauseLaw, InjectionObeysAnEquationOfItsOwn) {
  const Cause& cause = *find_cause(GetParam());
  const std::vector<Trial> trials = trials_of(cause);
  ASSERT_FALSE(trials.empty()) << "No equation holds the injection of " << cause.name
                               << ": its file declares none (Showing::law), nor does tests/hidden/equations.cpp.";
  StudyRecording recording = recording_in_motion();
  for (const Place& channel : channels_of(cause)) {
    ChannelGroup group;
    group.role = {channel.quantity, channel.axis, std::nullopt};
    const Draft before = blank_draft(recording, group, 1);
    for (const Trial& trial : trials) {
      const auto inject_into = [&](Draft draft, std::uint64_t seed) {
        Random random(seed, 5);
        inject(cause, draft, trial.values, random);
        return draft;
      };
      const Draft after = inject_into(before, 1000);
      EXPECT_TRUE(!stands_beside_white_noise(cause) || after.white == before.white);
      const Draft other = inject_into(blank_draft(recording, group, 2), 1001);
      const Injected injected{before, after, other, trial.values,
                              [&](std::uint64_t seed) { return inject_into(before, seed); }};
      for (const Figure& figure : trial.figures(injected)) {
        EXPECT_TRUE(holds(figure)) << channel.axis << ": " << figure.what << " is " << figure.seen << ", should be "
                                   << figure.expected << " within " << figure.tolerance;
      }
      expect_sharp(cause, trial, injected);
    }
  }
}

/// As print writes a parameter for which there is a symbol: sigma_s is σ, t0_s is t₀.
std::string symbol_of(const std::string& spoken) {
  static const std::map<std::string, std::string> symbols{{"sigma", "σ"}, {"beta", "β"}, {"nu", "ν"},  {"delta", "δ"},
                                                          {"eps", "ε"},   {"tau", "τ"},  {"t0", "t₀"}, {"f0", "f₀"},
                                                          {"f1", "f₁"},   {"S2", "S₂"},  {"S3", "S₃"}};
  const auto found = symbols.find(spoken);
  return found == symbols.end() ? spoken : found->second;
}

/// The text has the word with no letter of its own before or behind it: `S` stands in "S₂ ω", not in "Student".
bool has_word(const std::string& text, const std::string& word) {
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + word.size())) {
      return true;
    }
  }
  return false;
}

/// Pages, reports and terminals print the equation as it stands, where markup and programmers' notation are noise.
TEST_P(CauseLaw, EquationIsALineOfPrintThatNamesEveryParameter) {
  const Cause& cause = *find_cause(GetParam());
  const std::string equation(cause.equation);
  ASSERT_FALSE(equation.empty()) << cause.name << " declares no equation (Cause::equation)";
  EXPECT_EQ(equation.find_first_of("_^*\\$<>&`\n\t-"), std::string::npos) << equation;
  EXPECT_NE(equation.find_first_of('='), std::string::npos) << equation;
  for (const CauseParameter& parameter : cause.parameters) {
    EXPECT_TRUE(has_word(equation, symbol_of(spoken_name(parameter.name)))) << parameter.name << ": " << equation;
  }
  for (const Cause& other : cause_registry()) {
    EXPECT_TRUE(other.name == cause.name || other.equation != cause.equation) << other.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, CauseLaw, testing::ValuesIn(cause_names()),
                         [](const auto& instance) { return instance.param; });

TEST(Equations, EachIsThatOfARegisteredCause) {
  for (const Equation& equation : equations()) {
    EXPECT_NE(find_cause(equation.cause), nullptr) << equation.cause;
  }
}

}  // namespace
}  // namespace driftlab::hidden
