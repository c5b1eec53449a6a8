#include "clients/cli/cli.hpp"
#include "core/process/published_models.hpp"
#include "core/signal/number.hpp"
#include "core/signal/unit.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>
#include <memory>

namespace driftlab::cli {
namespace {

struct Flags {
  std::string preset = "iphone5s-z";
  std::string condition = "static";
  double rate_hz = 100.0;
  double duration_s = 900.0;
  std::uint64_t seed = 1;
  std::string out;
};

/// What the sensor would read besides its error: 0, the constant rate, or the ramp from rest [rad/s].
double reference(const Condition& condition, double t_s) {
  switch (condition.kind) {
    case ConditionKind::ConstantRate:
      return condition.value.value_or(0.0);
    case ConditionKind::ConstantAngularAcceleration:
      return condition.value.value_or(0.0) * t_s;
    default:
      return 0.0;
  }
}

Exit run(const Flags& flags) {
  auto condition = parse_condition(flags.condition);
  if (!condition) {
    return complain(condition.error());
  }
  auto model = published_model(flags.preset, *condition);
  if (!model) {
    return complain(model.error());
  }
  const double dt_s = 1.0 / flags.rate_hz;
  const auto samples = static_cast<std::size_t>(flags.duration_s * flags.rate_hz);
  Random random(flags.seed);
  const std::vector<double> error = simulate(*model, random, dt_s, samples);
  std::ofstream out(flags.out, std::ios::binary);
  out << "# Simulated by driftlab " DRIFTLAB_VERSION ", preset " << flags.preset << ", condition " << flags.condition
      << ", seed " << flags.seed << ", " << to_text(flags.rate_hz) << " Hz; see core/process/published_models.hpp\n"
      << "gz [deg/s]\n";
  const Unit unit = *parse_unit("deg/s");
  for (std::size_t i = 0; i < samples; ++i) {
    char line[32];
    const double value = unit.from_si(reference(*condition, static_cast<double>(i) * dt_s) + error[i]);
    const int length = std::snprintf(line, sizeof line, "%.6f\n", value);
    out.write(line, length);
  }
  out.close();
  if (!out) {
    return complain({ErrorCode::Io, "The file " + flags.out + " cannot be written.", {}});
  }
  return Exit::Success;
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand("simulate", "Write a recording simulated from a published error model");
  const auto flags = std::make_shared<Flags>();
  command->add_option("--preset", flags->preset, "Published model: iphone5s-z (Radi et al. 2017, Table 4)")
      ->capture_default_str();
  command->add_option("--condition", flags->condition, "Dynamic condition of the source's table")
      ->capture_default_str();
  command->add_option("--rate-hz", flags->rate_hz, "Sampling rate")->check(CLI::Range(0.1, 1e5))->capture_default_str();
  command->add_option("--duration-s", flags->duration_s, "Length")->check(CLI::Range(1.0, 1e6))->capture_default_str();
  command->add_option("--seed", flags->seed, "Same seed, same recording")->capture_default_str();
  command->add_option("--out", flags->out, "CSV file to write")->required();
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
