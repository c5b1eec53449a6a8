#include "server/access_commands.hpp"

#include "server/api/audit_row.hpp"
#include "server/auth/gate.hpp"
#include "server/open_store.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>

namespace driftlab::server {
namespace {

constexpr int kBroken = 3;

int complain(const Error& error) {
  std::fprintf(stderr, "driftlabd: %s\n", error.message.c_str());
  return error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull || error.code == ErrorCode::Internal ? 1 : 2;
}

std::string moment(const std::optional<UtcMicros>& time) { return time ? rfc3339(*time) : "-"; }

std::string state_of(const Token& token, UtcMicros now) {
  if (token.is_damaged) {
    return "damaged";
  }
  if (token.revoked_at) {
    return "revoked";
  }
  return token.expires_at && *token.expires_at <= now ? "expired" : "live";
}

int print_tokens(Gate& gate, UtcMicros now) {
  const auto tokens = gate.tokens();
  if (!tokens) {
    return complain(tokens.error());
  }
  std::printf("%-8s  %-5s  %-7s  %-24s  %-24s  %s\n", "id", "scope", "state", "expires", "last used", "name [devices]");
  for (const Token& token : *tokens) {
    std::string devices;
    for (const std::string& device : token.devices.value_or(std::vector<std::string>{})) {
      devices += (devices.empty() ? " [" : ", ") + device;
    }
    std::printf("%-8s  %-5s  %-7s  %-24s  %-24s  %s%s\n", token.id.c_str(), std::string(name_of(token.scope)).c_str(),
                state_of(token, now).c_str(), moment(token.expires_at).c_str(), moment(token.last_used_at).c_str(),
                token.name.c_str(), devices.empty() ? "" : (devices + "]").c_str());
  }
  return 0;
}

/// The secret alone on standard output, for `> file`; what it is on standard error.
int print_issued(const Result<IssuedToken>& issued) {
  if (!issued) {
    return complain(issued.error());
  }
  std::fprintf(stderr, "driftlabd: token %s, scope %s. The secret is shown this once:\n", issued->token.id.c_str(),
               std::string(name_of(issued->token.scope)).c_str());
  std::printf("%s\n", issued->secret.c_str());
  return 0;
}

int print_verdict(const AuditVerdict& verdict, const std::string& expected_head) {
  if (!verdict.fault.empty()) {
    std::fprintf(stderr, "driftlabd: The audit log is not whole. %s\n", verdict.fault.c_str());
    return kBroken;
  }
  std::printf("%lld rows, whole; head %s\n", static_cast<long long>(verdict.rows), verdict.head.c_str());
  if (!expected_head.empty() && expected_head != verdict.head) {
    std::fprintf(stderr, "driftlabd: The head is not the one given: rows were taken off the end, or added since.\n");
    return kBroken;
  }
  return 0;
}

int verify_file(const std::string& path, const std::string& expected_head) {
  std::ifstream file(path);
  if (!file) {
    return complain({ErrorCode::NotFound, "The file " + path + " cannot be opened.", {}});
  }
  AuditWalk walk;
  std::string line;
  for (std::int64_t number = 1; std::getline(file, line); ++number) {
    const auto row = audit_row_from_text(line);
    if (!row) {
      std::fprintf(stderr, "driftlabd: Line %lld of %s is no row of an audit log: %s\n", static_cast<long long>(number),
                   path.c_str(), row.error().message.c_str());
      return kBroken;
    }
    if (!walk.take(*row)) {
      break;
    }
  }
  return print_verdict(walk.verdict(), expected_head);
}

int print_audit(AccessStore& access) {
  constexpr int kPiece = 500;
  std::int64_t after = 0;
  while (true) {
    const auto rows = access.audit(after, kPiece, false);
    if (!rows) {
      return complain(rows.error());
    }
    for (const AuditRow& row : *rows) {
      std::printf("%s\n", to_text(to_json(row)).c_str());
      after = row.sequence;
    }
    if (rows->empty()) {
      return 0;
    }
  }
}

}  // namespace

AccessCommands::AccessCommands(CLI::App& app) {
  CLI::App* const token = app.add_subcommand("token", "Tokens of a daemon that does not run (else: /v1/tokens)");
  token->require_subcommand(1);
  create_ = token->add_subcommand("create",
                                  "Make a token and print its secret, once; with the first one every request "
                                  "needs a token");
  create_->add_option("--name", name_, "What it is for")->required();
  create_->add_option("--scope", scope_, "What it allows; each includes those before it")
      ->required()
      ->check(CLI::IsMember({"read", "write", "run", "admin"}));
  create_->add_option("--device", devices_, "Only device it may know of; may be given again");
  create_->add_option("--expires-days", expires_days_, "Days until it ends; without, it does not")
      ->check(CLI::Range(1, 3660));
  list_ = token->add_subcommand("list", "Every token that there ever was");
  revoke_ = token->add_subcommand("revoke", "End a token");
  revoke_->add_option("id", id_, "Public id of the token")->required();
  rotate_ = token->add_subcommand("rotate", "Give a token another secret and print it, once");
  rotate_->add_option("id", id_, "Public id of the token")->required();

  CLI::App* const audit = app.add_subcommand("audit", "The audit log of a daemon that does not run (else: /v1/audit)");
  audit->require_subcommand(1);
  verify_ = audit->add_subcommand("verify", "Recompute the chain of digests; 3 where it is broken");
  verify_->add_option("--file", file_, "An export instead of the database");
  verify_->add_option("--head", head_, "The digest that the last row must have");
  export_ = audit->add_subcommand("export", "Print every row as a line of JSON");
  for (CLI::App* const group : {token, audit}) {
    group->fallthrough();
    for (CLI::App* const command : group->get_subcommands([](CLI::App*) { return true; })) {
      command->fallthrough();
    }
  }
}

bool AccessCommands::parsed() const {
  for (const CLI::App* const command : {create_, list_, revoke_, rotate_, verify_, export_}) {
    if (command->parsed()) {
      return true;
    }
  }
  return false;
}

int AccessCommands::run(const Settings& settings) const {
  if (verify_->parsed() && !file_.empty()) {
    return verify_file(file_, head_);
  }
  const SystemClock machine;
  auto opened = open_existing_store(settings, machine);
  if (!opened && create_->parsed() && opened.error().code == ErrorCode::NotFound) {
    opened = open_store(settings, machine);  // a token may be made before the daemon first starts
  }
  if (!opened) {
    return complain(opened.error());
  }
  AccessStore& access = opened->store->access();
  const Clock& clock = *opened->clock;
  if (verify_->parsed()) {
    const auto verdict = access.verify_audit();
    return verdict ? print_verdict(*verdict, head_) : complain(verdict.error());
  }
  if (export_->parsed()) {
    return print_audit(access);
  }
  Gate gate(access, clock, {.budgets = settings.budgets});
  if (auto loaded = gate.load(); !loaded) {
    return complain(loaded.error());
  }
  const Caller command{Principal{"", "operator", Scope::Admin, {}, ""}, "", ""};
  const ActingFor acting(command);
  if (list_->parsed()) {
    return print_tokens(gate, clock.now());
  }
  if (revoke_->parsed()) {
    const auto revoked = gate.revoke(id_, true);
    return revoked ? 0 : complain(revoked.error());
  }
  if (rotate_->parsed()) {
    return print_issued(gate.rotate(id_));
  }
  NewToken wanted{name_, parse_scope(scope_).value_or(Scope::Public), std::nullopt, std::nullopt};
  if (!devices_.empty()) {
    wanted.devices = devices_;
  }
  if (expires_days_ > 0) {
    wanted.expires_at = clock.now() + expires_days_ * 86'400'000'000;
  }
  return print_issued(gate.create(wanted));
}

}  // namespace driftlab::server
