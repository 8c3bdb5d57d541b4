#include "src/app/render_picture.h"

#include <fmt/format.h>

#include "src/app/area_journal.h"
#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/dark_picture.h"
#include "src/app/denoised_rows.h"
#include "src/app/interrupt.h"
#include "src/app/print_message.h"
#include "src/cluster/one_rank.h"
#include "src/core/checksum.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"
#include "src/render/check_options.h"
#include "src/view/heat_picture.h"

namespace sheaf {
namespace {

std::uint64_t PixelCount(const PixelRect& area) {
  return static_cast<std::uint64_t>(area.width()) * static_cast<std::uint64_t>(area.height());
}

// Of one picture of a run.
std::uint64_t IdentityOf(std::uint64_t run, const Frame& frame) {
  Checksum checksum;
  checksum.Add(&run, sizeof(run));
  const std::string text =
      fmt::format("{} {} {}", frame.camera_index,
                  frame.number ? fmt::format("{}", *frame.number) : "-", frame.path);
  checksum.Add(text.data(), text.size());
  return checksum.value();
}

// Nothing without an identity.
Result<std::optional<AreaJournal>> OpenJournal(const RenderRequest& request, const Frame& frame,
                                               std::optional<std::uint64_t> identity) {
  std::optional<AreaJournal> journal;
  if (!identity) return journal;
  const std::string path = JournalPath(frame.path);
  Result<AreaJournal> opened = AreaJournal::Open(path, IdentityOf(*identity, frame));
  if (!opened) return opened.error();
  if (opened.value().was_other()) WarnOfOtherWork(request, path);
  journal.emplace(std::move(opened).value());
  return journal;
}

// Hands the rows from the top that an earlier run has left to `write`. Returns how many they are.
Result<int> Restore(const PixelRect& area, const RowSink& write, AreaJournal* journal) {
  int rows = 0;
  while (rows < area.height()) {
    const Result<Film> next = journal->TakeRows(area.y0 + rows);
    if (!next) return next.error();
    if (next.value().height == 0) break;
    if (const Status written = write(next.value()); !written) return written.error();
    rows += next.value().height;
  }
  return rows;
}

std::uint64_t EarlierPixels(const AreaJournal& journal) {
  std::uint64_t pixels = 0;
  for (const PixelRect& area : journal.earlier()) pixels += PixelCount(area);
  return pixels;
}

// Finished rows of `area`, from its top on, go to the journal, then to `write`.
RowSink KeepAndWrite(const PixelRect& area, const RowSink& write, AreaJournal* journal) {
  return [rest = area, &write, journal](const Film& rows) mutable {
    PixelRect band = rest;
    rest.y0 = band.y1 = band.y0 + rows.height;
    // On disk before anything else may fail.
    const Status kept = journal->Keep(band, rows);
    return kept ? write(rows) : kept;
  };
}

// Renders what the journal, which may be null, does not have: on all ranks with a leader, else in
// this process alone. That goes on as the only rank where several have left areas here and there.
Status RenderRest(const Renderer& renderer, const Frame& frame, const RenderOptions& options,
                  const RowSink& write, AreaJournal* journal, Leader* leader, FrameRecord* record,
                  RenderProgress* progress) {
  if (leader == nullptr && (journal == nullptr || journal->earlier().empty())) {
    const RowSink sink = journal ? KeepAndWrite(AreaOf(options), write, journal) : write;
    return renderer.RenderRows(*frame.camera, options, sink, &record->stats, progress);
  }
  const Scene& scene = renderer.scene();
  const Result<RenderOptions> checked = CheckOptions(options, scene.settings);
  if (!checked) return checked.error();
  const FrameOrder order{static_cast<int>(frame.camera_index), frame.number.has_value(),
                         frame.number.value_or(0), options.layers};
  OneRank one;
  std::optional<Leader> alone;
  Leader& lead = leader ? *leader : alone.emplace(one);
  const Status rendered = lead.RenderRows(scene, *frame.camera, order, checked.value(), write,
                                          journal, &record->stats, progress);
  if (leader) record->ranks = leader->records();
  return rendered;
}

}  // namespace

void WarnOfOtherWork(const RenderRequest& request, const std::string& journal) {
  if (request.quiet) return;
  PrintMessage(fmt::format("sheaf: warning: {}: of another scene, or other options; begun anew",
                           PrintablePath(journal)));
}

Result<FrameRecord> RenderPicture(const RenderRequest& request, const Renderer& renderer,
                                  Frame frame, const RenderOptions& options, ProgressStyle style,
                                  const std::string& label, std::optional<std::uint64_t> identity,
                                  Leader* leader) {
  const Scene& scene = renderer.scene();
  FrameRecord record{frame.camera->name, frame.number, frame.path, options, {}};
  if (!frame.look && !HoldsFloats(FormatPath(frame.path, frame.format))) {
    const Result<Look> look = ChooseLook(request.look, renderer, *frame.camera, options);
    if (!look) return look.error();
    frame.look = look.value();
  }
  frame.is_denoised = !request.denoise.empty();
  // Before the first ray: what cannot be written costs no rendering.
  Result<FrameWriter> writer =
      FrameWriter::Create(scene, frame, options, request.bits, request.scene);
  if (!writer) return writer.error();
  Result<std::optional<AreaJournal>> journal = OpenJournal(request, frame, identity);
  if (!journal) return journal.error();
  HeatPicture heat(options);
  DarkPicture dark(scene.settings.transfer, frame.look.value_or(Look()).ev);
  const RowSink finish = [&](const Film& rows) {
    dark.AddRows(rows);
    if (options.layers.has(Layer::kHeat)) heat.AddRows(rows);
    return writer.value().WriteRows(rows);
  };
  const Result<std::optional<DenoiseFilter>> filter = ChooseDenoiseFilter(request.denoise);
  if (!filter) return filter.error();
  DenoisedRows denoised(options, filter.value(), finish);
  const RenderOptions& work = denoised.work();
  const RowSink write = [&](const Film& rows) { return denoised.Write(rows); };
  const PixelRect area = AreaOf(work);
  PixelRect rest = area;
  AreaJournal* const kept = journal.value() ? &*journal.value() : nullptr;
  if (kept != nullptr) {
    if (const Status loaded = kept->Load(area, work.layers); !loaded) return loaded.error();
    const std::uint64_t earlier = EarlierPixels(*kept);
    record.resumed_rows = static_cast<int>(earlier / static_cast<std::uint64_t>(area.width()));
    if (earlier > 0 && !request.quiet) {
      PrintMessage(fmt::format("{}: goes on after {} of {} rows", label, record.resumed_rows,
                               area.height()));
    }
    const Result<int> rows = Restore(area, write, kept);
    if (!rows) return rows.error();
    rest.y0 += rows.value();
  }
  if (rest.height() > 0) {
    FrameWatch watch(style, label, options,
                     PixelCount(rest) - (kept == nullptr ? 0 : EarlierPixels(*kept)));
    RenderOptions left = work;
    if (rest.y0 > area.y0) left.crop = rest;
    const Status rendered =
        RenderRest(renderer, frame, left, write, kept, leader, &record, watch.progress());
    // A signal in the last tenth of a second may find the frame finished. The command stops even
    // so.
    if (PendingSignal() != 0 || (!rendered && rendered.error().kind == ErrorKind::kInterrupted)) {
      return Error{ErrorKind::kInterrupted,
                   fmt::format("interrupted; {} was not written{}", frame.path,
                               journal.value() ? "; --resume goes on with it" : "")};
    }
    if (!rendered) return rendered.error();
    watch.Finish(record.stats);
  }
  if (const Status ended = denoised.Finish(); !ended) return ended.error();
  if (const Status written = writer.value().Finish(); !written) return written.error();
  // A part of a picture may well be empty.
  if (!options.crop && !request.quiet) {
    const Result<std::string> reason = dark.Explain(renderer, *frame.camera, options);
    if (reason && !reason.value().empty()) PrintMessage("sheaf: warning: " + reason.value());
  }
  for (const auto& [layer, path] : frame.beside) {
    if (layer != Layer::kHeat) continue;
    if (const Status written = heat.Write(path); !written) return written.error();
  }
  return record;
}

}  // namespace sheaf
