#pragma once
/// Wavelet variances of every kind of process that a composite model may hold, ready for a search over their shapes.
///
/// A composite model is a sum of processes of any registered kinds. A kind gives its wavelet variances in closed form
/// or, known by its density alone, through core/variance/spectral_table.hpp; its density makes the scatter of the
/// estimates. Kinds without a density, a drift and a sinusoid, add no scatter. A kind with one smooth shape is
/// tabulated on 64 values of it and interpolated (cubic, by value and slope; error below 1e-4 of the variance); others
/// are evaluated where they are asked for.
#include "core/process/process.hpp"
#include "core/variance/spectral_table.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace driftlab {

/// A kind as the search sees it.
struct CompositeKind {
  const ProcessKind* kind = nullptr;
  std::vector<std::pair<double, double>> log_range;  ///< of the logarithm of each shape, SI
  std::size_t nodes = 64;                            ///< of the table and of the scan of the first shape
  bool smooth = true;                                ///< may be interpolated between nodes
  bool repeats = false;                              ///< may a model hold several?
  bool at_lines_only = false;                        ///< joins the search only where the periodogram has a line

  [[nodiscard]] std::size_t shapes() const { return log_range.size(); }
};

/// One process of a composite model.
struct Component {
  std::size_t kind = 0;     ///< index into CompositeBasis::kinds()
  double log_square = 0.0;  ///< ln of the squared level
  std::array<double, kMostShapes> log_shape{};
  /// ln of the frequency of the line that a resonance or sinusoid was found at: its own stays within 15 % of that.
  std::optional<double> line = std::nullopt;
};
using Composite = std::vector<Component>;

/// ln of the wavelet variances of one process of level 1, and its derivatives by the logarithms of its shapes. The
/// entry after the last scale is ln of its density at frequency 0 [unit^2 s]; meaningless for kinds that have none
/// there.
struct LogColumn {
  Eigen::VectorXd value;
  std::array<Eigen::VectorXd, kMostShapes> slope;
};

/// Immutable. Making one takes a few milliseconds.
class CompositeBasis {
 public:
  CompositeBasis(std::shared_ptr<const SpectralTable> table, std::vector<CompositeKind> kinds, double dt_s);

  [[nodiscard]] const std::vector<CompositeKind>& kinds() const { return kinds_; }
  [[nodiscard]] const SpectralTable& table() const { return *table_; }
  [[nodiscard]] double dt_s() const { return dt_s_; }

  void column(const Component& component, bool with_slopes, LogColumn& out) const;
  /// Where shape `s` of a component may lie.
  [[nodiscard]] std::pair<double, double> range(const Component& component, std::size_t s) const;
  /// Density at the table's frequencies [unit^2], per sample.
  [[nodiscard]] Eigen::VectorXd density(const Component& component) const;
  [[nodiscard]] Eigen::VectorXd density(const Composite& model) const;
  /// Wavelet variances of a model [unit^2].
  [[nodiscard]] Eigen::VectorXd variance(const Composite& model) const;
  /// Values of the first shape at which a kind is scanned.
  [[nodiscard]] std::span<const double> scan(std::size_t kind) const { return tables_[kind].log_shape; }
  /// ln of the wavelet variances on the scan, scales (and the density at 0) x values; of a kind without shapes one
  /// column.
  [[nodiscard]] const Eigen::MatrixXd& scanned(std::size_t kind) const { return tables_[kind].value; }
  /// Whether the process adds white noise at low frequencies: its density at 1/30 cycle per sample is at least half of
  /// that at 0 (a Gauss-Markov process with beta dt of 0.2 or more).
  [[nodiscard]] bool is_fast(const Component& component) const;
  [[nodiscard]] Process process(const Component& component) const;

 private:
  struct Table {
    std::vector<double> log_shape;
    Eigen::MatrixXd value;
    Eigen::MatrixXd slope;
  };
  void evaluate(const Component& component, Eigen::VectorXd& out) const;
  /// The same with the derivatives.
  void differentiate(const Component& component, LogColumn& out) const;

  std::shared_ptr<const SpectralTable> table_;
  std::vector<CompositeKind> kinds_;
  double dt_s_;
  std::vector<double> half_;
  std::vector<Table> tables_;
};

}  // namespace driftlab
