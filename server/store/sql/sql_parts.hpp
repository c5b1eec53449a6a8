#pragma once
/// The parts of jobs on the transactions of a database.
#include "server/store/part_store.hpp"
#include "server/store/sql/database.hpp"

namespace driftlab::server {

class SqlParts final : public PartStore {
 public:
  explicit SqlParts(Database& database) : database_(database) {}

  [[nodiscard]] Result<LeaseStatus> divide(const Lease& lease, std::int64_t count, std::string_view program) override;
  [[nodiscard]] Result<std::optional<Job>> job_to_help(const std::vector<KnownKind>& known,
                                                       std::string_view program) override;
  [[nodiscard]] Result<std::optional<PartClaim>> claim_part(std::string_view job_id, bool own,
                                                            std::int64_t lease_micros) override;
  [[nodiscard]] Result<LeaseStatus> renew_part(const PartClaim& claim, std::int64_t lease_micros) override;
  [[nodiscard]] Result<LeaseStatus> finish_part(const PartClaim& claim, std::string_view result) override;
  [[nodiscard]] Result<LeaseStatus> put_back_part(const PartClaim& claim) override;
  [[nodiscard]] Result<std::vector<std::string>> finished_parts(std::string_view job_id, std::int64_t first,
                                                                int limit) override;
  [[nodiscard]] Result<std::int64_t> count_finished_parts(std::string_view job_id) override;

 private:
  Database& database_;
};

}  // namespace driftlab::server
