#include "server/http/names.hpp"

#include <boost/algorithm/string/predicate.hpp>

#include <locale>

namespace driftlab::server {

bool same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && boost::algorithm::iequals(a, b, std::locale::classic());
}

}  // namespace driftlab::server
