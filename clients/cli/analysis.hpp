#pragma once
/// Two ways to the same characterisation document: in this process, or through a daemon.
#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/remote_job.hpp"
#include "core/analysis/characterise_campaign.hpp"

#include <string>
#include <vector>

namespace driftlab::cli {

/// Decodes, maps and characterises each file here; `check`, which may be empty, is asked of each before. Cancelled by
/// interrupt_token.
[[nodiscard]] tl::expected<CharacterisedCampaign, Failure> characterise_here(const Inputs& inputs,
                                                                             const CharacteriseOptions& options,
                                                                             ColumnCheck check = {});

/// What was characterised here as the document that --json prints.
[[nodiscard]] Json as_document(const CharacterisedCampaign& campaign, const Inputs& inputs);

/// Uploads each file, and a study as a study, queues one job for all of them, follows its events and fetches its
/// result. Calibrations that files name are stored there first.
[[nodiscard]] tl::expected<Json, Failure> characterise_there(const Inputs& inputs, const CharacteriseOptions& options,
                                                             const std::string& server);

/// A document of the daemon with its recordings called as the inputs call them, wherever it names them: what is printed
/// is then what is printed without a daemon.
[[nodiscard]] Json named_as_here(Json document, const Inputs& inputs);

/// What parameter tables are made of.
struct TabledCampaign {
  std::vector<SensorSources> sensors;
  std::vector<PooledSensor> pooled;
  std::vector<Remark> remarks;  ///< by recording, those of a recording before those of its channels
};

/// Of recordings characterised here, without a document in between.
[[nodiscard]] TabledCampaign tabled(const CharacterisedCampaign& campaign);

/// Of a characterisation document, from a daemon or a file. Error: Internal, for a document that driftlab has not
/// written.
[[nodiscard]] Result<TabledCampaign> tabled_from_json(const Json& document);

/// Whether a table names its columns as options and documents do, or as they are printed.
enum class TableNames { AsTyped, InPrint };

/// Parameter tables, as text, of every sensor axis, by both methods. `hardware`: texts that describe the device, in
/// which its sensor may be named.
[[nodiscard]] std::string tables_of(const TabledCampaign& campaign, const std::string& device,
                                    const std::vector<std::string>& hardware, TableNames names);

}  // namespace driftlab::cli
