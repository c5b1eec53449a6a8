// `driftlab watch`: what a daemon is doing, a line for each thing that happens.
#include "clients/cli/remote_job.hpp"
#include "core/signal/number.hpp"
#include "schema/json/stored_member.hpp"

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

constexpr std::chrono::seconds kPause{1};
constexpr int kMostRefusals = 30;  ///< of a daemon that is restarted; then it is taken to be gone

struct WatchFlags {
  std::string server = "http://127.0.0.1:8477";
  std::string job;
  bool all = false;
  bool json = false;
};

/// `2026-11-22T09:30:00.123Z job_... running 45 % fit WN+GM`
void print_event(const Json& event, bool json) {
  if (json) {
    std::printf("%s\n", to_text(event).c_str());
  } else if (event.contains("state")) {
    const std::string stage = text_member(event, "stage");
    const std::string kind = text_member(event, "kind");
    const double progress =
        event.contains("progress") && event["progress"].is_number() ? event["progress"].get<double>() : 0.0;
    std::printf("%s  %s%s  %-9s %3.0f %%%s\n", text_member(event, "at").c_str(), text_member(event, "job").c_str(),
                kind.empty() ? "" : ("  " + kind).c_str(), text_member(event, "state").c_str(),
                std::floor(100.0 * progress), stage.empty() ? "" : ("  " + stage).c_str());
  } else {
    const std::string verdict = text_member(event, "verdict");
    std::printf("%s  %s%s\n", text_member(event, "job").c_str(), text_member(event, "href").c_str(),
                verdict.empty() ? "" : ("  " + verdict).c_str());
  }
  std::fflush(stdout);
}

/// Everything that jobs of the daemon do, until it is gone for good or somebody interrupts.
Exit watch_all(HttpClient& client, bool json) {
  std::string last_id;
  Error lost{ErrorCode::Io, "The daemon does not answer.", {}};
  for (int refusals = 0; refusals < kMostRefusals; ++refusals) {
    const Status followed = client.follow(
        "/v1/events?topics=jobs,results",
        [&](std::string_view data) {
          refusals = 0;
          const auto event = parse_json(data);
          if (event && event->is_object() && !event->empty()) {  // empty: the stream is ready
            print_event(*event, json);
          }
          return true;
        },
        &last_id);
    lost = followed ? lost : followed.error();
    if (last_id.empty()) {
      const auto why = client.get("/v1/session");  // nothing came at all: it is not there, or does not want us
      if (!why) {
        return complain(why.error(), Exit::ServerOrJob);
      }
      if (why->status != 200) {
        const Failure failure = refused(*why).value();
        return complain(failure.error, failure.exit);
      }
    }
    std::this_thread::sleep_for(kPause);
  }
  return complain(lost, Exit::ServerOrJob);
}

/// One job to its end, which is the exit code.
Exit watch_job(HttpClient& client, const std::string& job, bool json) {
  const std::string target = "/v1/jobs/" + percent_encode(job);
  std::string last_id;
  Error lost{ErrorCode::Io, "The daemon does not say how job " + job + " is doing.", {}};
  for (int refusals = 0; refusals < kMostRefusals; ++refusals) {
    const auto reply = client.get(target);
    if (!reply && last_id.empty() && refusals == 0) {
      return complain(reply.error(), Exit::ServerOrJob);
    }
    if (reply && reply->status != 200) {
      const Failure failure = refused(*reply).value();
      return complain(failure.error, failure.exit);
    }
    std::string state;
    const Status followed = client.follow(
        target + "/events",
        [&](std::string_view data) {
          if (const auto event = parse_json(data); event && event->is_object()) {
            refusals = 0;
            print_event(*event, json);
            state = text_member(*event, "state");
          }
          return true;
        },
        &last_id);
    if (state.empty() && reply) {  // it had ended before
      const auto document = parse_json(reply->body);
      state = document ? text_member(*document, "state") : "";
    }
    if (state == "succeeded") {
      return Exit::Success;
    }
    if (state == "failed" || state == "cancelled" || state == "dead") {
      const auto ended = client.get(target);
      const auto document = ended ? parse_json(ended->body) : Result<Json>(Json::object());
      const bool told = document && document->contains("problem") && (*document)["problem"].is_object();
      const std::string detail = told ? text_member((*document)["problem"], "detail") : "";
      std::string sentence = "The job ";
      sentence.append(job).append(" ended ").append(state).append(detail.empty() ? "." : ": ").append(detail);
      return complain({ErrorCode::Internal, std::move(sentence), {}}, Exit::ServerOrJob);
    }
    lost = followed ? lost : followed.error();
    std::this_thread::sleep_for(kPause);
  }
  return complain(lost, Exit::ServerOrJob);
}

Exit run(const WatchFlags& flags) {
  if (flags.all != flags.job.empty()) {
    return complain({ErrorCode::InvalidArgument, "Name one job, or say --all.", {}});
  }
  auto client = HttpClient::to(flags.server);
  if (!client) {
    return complain(client.error());
  }
  // There is nothing to put in order: an interrupt ends the wait for the next event at once.
  const std::stop_callback leave(interrupt_token(), [] { _exit(static_cast<int>(Exit::Interrupted)); });
  return flags.all ? watch_all(*client, flags.json) : watch_job(*client, flags.job, flags.json);
}

}  // namespace

void add_watch(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand("watch", "Follow a job of a daemon to its end, or all of them");
  const auto flags = std::make_shared<WatchFlags>();
  command->add_option("JOB", flags->job, "Id of the job");
  command->add_flag("--all", flags->all, "Everything that jobs do, and their results, until interrupted");
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_flag("--json", flags->json, "Print each event as a line of JSON");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
