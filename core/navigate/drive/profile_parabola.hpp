#pragma once
/// The top of a log likelihood along one parameter, and an uncertainty that holds where the model is not quite right.
///
/// Model: l(x) = sum_b l_b(x) over blocks of time b. Near its top x0 a parabola of curvature H = -l''(x0) through three
/// values has its own top as estimate. Were the innovations white and of their stated size, the estimate's variance
/// would be 1/H. A filter is never quite right: an effect that it does not know makes innovations that belong together,
/// and these pull x one way for seconds. The estimate solves sum_b s_b = 0 with s_b = l_b'(x0), so that its variance is
///
///   V = J / H^2,   J = B/(B - 1) sum_b (s_b - mean s)^2
///
/// (quasi maximum likelihood: Huber 1967, theorem 3; White, Econometrica 50 (1982), eq. (3.2); blocks longer than the
/// dependence in place of single innovations: Liang and Zeger, Biometrika 73 (1986), eq. (3.6)). V = 1/H where the
/// model is right. s_b is the slope of block b's own parabola through the same three values.
///
/// Blocks must be longer than what they share. How long that is nobody knows beforehand: J is made of the given blocks,
/// of pairs, of fours and so on, as long as six are left, and the largest counts. (The clock of rtk-car-0708 runs at
/// another rate than the fixes': J of its offset goes on growing, 5.6^2, 7.0^2 and 9.3^2 times H at 20, 40 and 80 s.)
///
/// V of B blocks scatters by sqrt(2/B) of itself, 27 % at 27 and 58 % at six, and too small a one would name a cause:
/// the stated error is never below 1.5/sqrt(H). (On simulated drives, where the filter is right but for its
/// linearisation and levels of the noise are fitted beside the parameter, estimates scatter by 0.7 to 1.7 of
/// 1/sqrt(H).) Error and score are both those of a log likelihood divided by
///
///   divisor = max(1.5^2, J/H):   se = sqrt(divisor/H),   score = gain/divisor
///
/// (Kent, Biometrika 69 (1982): under a wrong model twice the log likelihood ratio of one parameter is J/H times a chi
/// square). The other parameters are held: one that shares a ridge with another is less well known than is said here.
///
/// Cost: O(B log B). Deterministic.
#include <array>
#include <vector>

namespace driftlab::drive {

/// Log likelihoods of one value of a parameter.
struct ProfilePoint {
  double at = 0.0;             ///< the parameter, relative to the present value
  std::vector<double> blocks;  ///< by time
  [[nodiscard]] double sum() const;
};

/// Where a profile has its top, relative to the present value, SI.
struct ProfileEstimate {
  bool sound = false;  ///< the profile is concave there
  double value = 0.0;
  double curvature_se = 0.0;  ///< 1/sqrt(H)
  double sandwich_se = 0.0;   ///< sqrt(J)/H; 0 of one block
  double se = 0.0;            ///< what is stated
  double top = 0.0;           ///< log likelihood
  double divisor = 1.0;       ///< of the log likelihood, for scores
  double score = 0.0;
  [[nodiscard]] double gain_to(double at) const { return sound ? top - at : 0.0; }
};

/// What a log likelihood is divided by at least.
inline constexpr double kLeastDivisor = 1.5 * 1.5;

/// The parabola through three values, by rising parameter and with the same blocks. Not sound where it is not concave
/// or a value is not finite. The top is not sought beyond the outer two.
[[nodiscard]] ProfileEstimate parabola_through(const std::array<ProfilePoint, 3>& points);

/// Error, divisor and score of a parameter whose profile from nothing to its top is no parabola, as of one whose top
/// lies at its own end. The gain g = sum_b d_b, d_b = l_b(top) - l_b(nothing), scatters by
///   W = B/(B - 1) sum_b (d_b - mean d)^2
/// (Vuong, Econometrica 57 (1989), section 4), made of blocks as J is. On a parabola g = x^2 H/2 and W = x^2 J, so that
///   divisor = max(1.5^2, W/(2 g)),   score = g/divisor,   se = x/sqrt(2 score)
/// are then what the slopes say, and the error leaves 0 as far away as the likelihood does in any case. `value`: of the
/// parameter at the top. Nothing is changed where the top is no better than nothing.
void judge_against_nothing(ProfileEstimate& estimate, double value, const ProfilePoint& top,
                           const ProfilePoint& nothing);

}  // namespace driftlab::drive
