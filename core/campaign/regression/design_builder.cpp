#include "core/campaign/regression/design_builder.hpp"

#include "core/process/registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace driftlab::regression {
namespace {

double margin_at(const Margins& margins, double tau_s) {
  const double percent = tau_s <= 1.0 ? margins.percent[0] : tau_s <= 10.0 ? margins.percent[1] : margins.percent[2];
  return std::log1p(percent / 100.0);
}

/// By the declared unit of the level: N has a root of time, sigma and B none, the others more.
double margin_of(const Level& level, const Margins& margins, const Settings& settings) {
  const ProcessKind* const kind = find_process(level.process);
  const int halves = kind != nullptr ? kind->parameters[0].second_power_halves : 0;
  const double percent = halves == 1   ? margins.percent[0]
                         : halves == 0 ? settings.margin_sigma_percent
                                       : settings.margin_slow_percent;
  return std::log1p(percent / 100.0);
}

/// A white density must be shown where the scales that must be shown consist of it by half.
bool is_gated(const Level& level, const PooledUnit& pooled, Eigen::Index p, std::size_t rows, double through_s) {
  const ProcessKind* const kind = find_process(level.process);
  bool shows = false;
  for (std::size_t row = 0; row < rows; ++row) {
    shows = shows || (pooled.tau_s[row] <= through_s && pooled.sensitivity(static_cast<Eigen::Index>(row), p) >= 0.5);
  }
  return shows && kind != nullptr && kind->white_square != nullptr;
}

}  // namespace

DesignBuilder::DesignBuilder(const ComparedSessions& sessions, const Settings& settings)
    : sessions_(sessions),
      settings_(settings),
      all_(sessions.all()),
      x_(all_.size()),
      has_(all_.size()),
      sampling_(all_.size()) {}

bool DesignBuilder::add(const NamedUnit& named, UnitReport& told, const std::stop_token& stop) {
  std::vector<SessionChannels> channels;
  for (const PowerUp* session : all_) {
    channels.push_back(channels_of(*session, named.name));
  }
  const auto pooled = pool_unit(channels, sessions_.compared(), stop);
  if (!pooled || rows_of(*pooled) == 0) {
    return false;
  }
  const std::size_t rows = rows_of(*pooled);
  mixed_rates_ = mixed_rates_ || pooled->mixed_rates;
  const bool gyroscope = named.quantity == Quantity::AngularRate;
  const Margins& margins = gyroscope ? settings_.gyroscope : settings_.accelerometer;
  Unit unit;
  unit.tau0 = gyroscope ? settings_.tau0_gyroscope : settings_.tau0_accelerometer;
  unit.first = design_.rows.size();
  unit.count = rows;
  unit.levels = pooled->levels;
  unit.shapes = pooled->shapes;
  const auto count = static_cast<Eigen::Index>(rows);
  if (!unit.levels.empty()) {
    unit.modelled = pooled->modelled.head(count);
    unit.sensitivity = pooled->sensitivity.topRows(count);
  }
  for (std::size_t p = 0; p < unit.levels.size(); ++p) {
    unit.levels[p].margin = margin_of(unit.levels[p], margins, settings_);
    unit.levels[p].gated =
        is_gated(unit.levels[p], *pooled, static_cast<Eigen::Index>(p), rows, settings_.test.through_s);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double tau_s = pooled->tau_s[row];
    design_.rows.push_back({design_.units.size(), static_cast<int>(row), tau_s, margin_at(margins, tau_s)});
    told.tau_s.push_back(tau_s);
  }
  told.model = pooled->model;
  told.robust = pooled->robust;
  for (std::vector<double>& edf : told.edf) {
    edf.assign(rows, 0.0);
  }
  for (std::size_t s = 0; s < all_.size(); ++s) {
    add_session(s, pooled->sessions[s], rows, told);
  }
  design_.units.push_back(std::move(unit));
  return true;
}

void DesignBuilder::finish() {
  std::map<std::vector<bool>, std::size_t> groups;
  for (std::size_t s = 0; s < all_.size(); ++s) {
    Session session;
    session.arm = arm_of(s);
    session.release = release_of(s);
    session.x = Eigen::Map<const Eigen::VectorXd>(x_[s].data(), static_cast<Eigen::Index>(x_[s].size()));
    session.has = has_[s];
    std::vector<bool> units;
    for (const Unit& unit : design_.units) {
      units.push_back(has_[s][unit.first]);
    }
    session.group = groups.emplace(units, groups.size()).first->second;
    for (const Session& other : design_.sessions) {  // equal lengths share one law
      if (*other.sampling == sampling_[s]) {
        session.sampling = other.sampling;
        break;
      }
    }
    if (session.sampling == nullptr) {
      session.sampling = std::make_shared<Sampling>(sampling_[s]);
    }
    design_.sessions.push_back(std::move(session));
  }
}

Arm DesignBuilder::arm_of(std::size_t session) const {
  return session < sessions_.baseline.sessions.size() ? Arm::Baseline
         : session < sessions_.compared()             ? Arm::Candidate
                                                      : Arm::History;
}

std::size_t DesignBuilder::release_of(std::size_t session) const {
  std::size_t first = sessions_.compared();
  for (std::size_t release = 0; release < sessions_.history.size(); ++release) {
    first += sessions_.history[release].sessions.size();
    if (session < first) {
      return release;
    }
  }
  return 0;
}

std::size_t DesignBuilder::rows_of(const PooledUnit& pooled) const {
  std::array<std::size_t, 2> reach{0, 0};
  for (std::size_t s = 0; s < sessions_.compared(); ++s) {
    std::size_t& own = reach[arm_of(s) == Arm::Candidate ? 1 : 0];
    for (std::size_t row = own; row < pooled.tau_s.size(); ++row) {
      if (pooled.sessions[s].edf(static_cast<Eigen::Index>(row)) >= settings_.min_edf) {
        own = row + 1;
      }
    }
  }
  return std::min(reach[0], reach[1]);
}

void DesignBuilder::add_session(std::size_t s, const SessionCurve& curve, std::size_t rows, UnitReport& told) {
  const auto count = static_cast<Eigen::Index>(rows);
  for (Eigen::Index row = 0; row < count; ++row) {
    const bool has = curve.edf(row) >= settings_.min_edf;
    x_[s].push_back(has ? curve.x(row) : 0.0);
    has_[s].push_back(has);
    if (arm_of(s) != Arm::History) {
      told.edf[arm_of(s) == Arm::Candidate ? 1 : 0][static_cast<std::size_t>(row)] += curve.edf(row);
    }
  }
  sampling_[s].push_back(curve.sampling.topLeftCorner(count, count));
}

}  // namespace driftlab::regression
