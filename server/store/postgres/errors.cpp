#include "server/store/postgres/connection.hpp"
#include "server/store/silent_store.hpp"

namespace driftlab::server {
namespace {

/// The first line, without a full stop: libpq adds hints on further lines.
std::string first_line(const std::string& reason) {
  std::string line = reason.substr(0, reason.find('\n'));
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) {
    line.pop_back();
  }
  return line.empty() ? "no reason was given" : line;
}

}  // namespace

/// https://www.postgresql.org/docs/15/errcodes-appendix.html
Error postgres_error(std::string_view sqlstate, const std::string& reason, const std::string& database) {
  const std::vector<ErrorField> fields = {{"database", database}, {"sqlstate", std::string(sqlstate)}};
  const std::string why = first_line(reason);
  const auto error = [&](ErrorCode code, const std::string& sentence) { return Error{code, sentence, fields}; };
  const std::string_view group = sqlstate.substr(0, 2);
  if (sqlstate == "53100") {
    return error(ErrorCode::DiskFull, "The disk of the database " + database + " is full.");
  }
  if (sqlstate == "25006") {
    return error(ErrorCode::Io, "The database " + database + " is read-only; name the primary server.");
  }
  if (sqlstate == "42501") {
    return error(ErrorCode::Io, "The database " + database + " does not let its user do that: " + why + ".");
  }
  if (sqlstate == "57014" || sqlstate == "55P03") {
    return error(ErrorCode::Io, "The database " + database + " took too long: " + why + ".");
  }
  if (group == "08" || sqlstate == "57P01" || sqlstate == "57P02" || sqlstate == "57P03" || sqlstate == "53300") {
    return silent_store("The database " + database + " does not answer: " + why + ".", fields);
  }
  if (group == "22" || group == "23" || group == "42" || sqlstate == "P0001") {
    return error(ErrorCode::Internal, "The database refused a statement: " + why + ".");
  }
  return error(ErrorCode::Io, "The database " + database + " could not be read or written: " + why + ".");
}

}  // namespace driftlab::server
