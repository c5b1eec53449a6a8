#include "core/process/published_models.hpp"

#include "core/signal/angle.hpp"

#include <array>
#include <cmath>

namespace driftlab {
namespace {

/// A row of Table 4; a beta of 0 means that the process is not there.
struct Table4Row {
  std::string_view condition;
  double n, beta1, sigma1_squared, beta2, sigma2_squared;
};

constexpr std::array kIphone5sZ{
    Table4Row{"static", 1.034, 1.7101, 7.049, 9.7259e-3, 1.0601},
    Table4Row{"constant_rate:z:9:deg/s", 1.483, 1.812, 10.9602, 1.5432e-2, 0.9763},
    Table4Row{"constant_rate:z:18:deg/s", 2.6197, 6.9739, 17.709, 7.2487e-2, 1.7943},
    Table4Row{"constant_rate:z:36:deg/s", 1.7224, 1.8926, 18.4464, 1.4675e-2, 1.149188},
    Table4Row{"constant_rate:z:120:deg/s", 3.4084, 0.16507, 0.3293, 1.6252e-2, 1.26445},
    Table4Row{"constant_angular_acceleration:z:1:deg/s^2", 2.3335, 1.4157, 24.854, 0.0, 0.0},
    Table4Row{"constant_angular_acceleration:z:2:deg/s^2", 1.6842, 1.4488, 23.8911, 0.0, 0.0},
};

double sigma_rad_s(double squared) { return std::sqrt(squared) / 60.0 * kDegree; }

Model model_of(const Table4Row& row) {
  Model model;
  model.push_back(*make_process("white_noise", {row.n / 60.0 * kDegree}));
  model.push_back(*make_process("gauss_markov", {sigma_rad_s(row.sigma1_squared), row.beta1}));
  if (row.beta2 > 0.0) {
    model.push_back(*make_process("gauss_markov", {sigma_rad_s(row.sigma2_squared), row.beta2}));
  }
  return model;
}

}  // namespace

const std::vector<PublishedModel>& published_models() {
  static const std::vector<PublishedModel> models = [] {
    std::vector<PublishedModel> list;
    list.reserve(kIphone5sZ.size());
    for (const Table4Row& row : kIphone5sZ) {
      list.push_back({"iphone5s-z", *parse_condition(row.condition), model_of(row)});
    }
    return list;
  }();
  return models;
}

Result<Model> published_model(std::string_view preset, const Condition& condition) {
  std::string known;
  for (const PublishedModel& entry : published_models()) {
    if (entry.preset == preset && entry.condition == condition) {
      return entry.model;
    }
    known += (known.empty() ? "" : ", ") + std::string(entry.preset) + " under " + to_text(entry.condition);
  }
  return fail(ErrorCode::NotFound, "There is no published model " + std::string(preset) + " under " +
                                       to_text(condition) + "; there are " + known + ".");
}

}  // namespace driftlab
