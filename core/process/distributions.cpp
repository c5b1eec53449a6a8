#include "core/process/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>

namespace driftlab {
namespace {

namespace policies = boost::math::policies;

/// NaN and infinities instead of exceptions.
using Quiet =
    policies::policy<policies::domain_error<policies::ignore_error>, policies::pole_error<policies::ignore_error>,
                     policies::overflow_error<policies::ignore_error>,
                     policies::evaluation_error<policies::ignore_error>>;
using Normal = boost::math::normal_distribution<double, Quiet>;
using ChiSquared = boost::math::chi_squared_distribution<double, Quiet>;
using Student = boost::math::students_t_distribution<double, Quiet>;

}  // namespace

double normal_tail(double x) { return boost::math::cdf(boost::math::complement(Normal(), x)); }
double normal_quantile(double p) { return boost::math::quantile(Normal(), p); }
double normal_density(double x) { return boost::math::pdf(Normal(), x); }

double chi_squared_tail(double x, double dof) {
  return x < 0.0 ? 1.0 : boost::math::cdf(boost::math::complement(ChiSquared(dof), x));
}
double chi_squared_quantile(double p, double dof) { return boost::math::quantile(ChiSquared(dof), p); }

double student_tail(double t, double dof) { return boost::math::cdf(boost::math::complement(Student(dof), t)); }
double student_quantile(double p, double dof) { return boost::math::quantile(Student(dof), p); }

double digamma(double x) { return boost::math::digamma(x, Quiet()); }
double log_gamma(double x) { return boost::math::lgamma(x, Quiet()); }
double trigamma(double x) { return boost::math::trigamma(x, Quiet()); }

}  // namespace driftlab
