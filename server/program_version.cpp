#include "server/program_version.hpp"

namespace driftlab::server {

std::string_view program_version() { return DRIFTLAB_VERSION; }

}  // namespace driftlab::server
