#include <isolux/volume_io/write.h>

#include <memory>

#include "commands.h"
#include "volume_options.h"

namespace isolux {

void add_convert_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("convert", "Between the volume formats that can be written");
  struct Options {
    VolumeOptions volume;
    std::string output;
    WriteOptions write;
  };
  const auto options = std::make_shared<Options>();
  options->volume.add_to(command);
  command.add_option("OUT", options->output, "the file to write; its extension names the format")->required();
  command.add_flag("--compress", options->write.compress, "gzip, where the format has it");
  session.add_common_options(command);
  command.callback([options, &session] {
    session.on_run([options, &session] {
      session.require_outputs({{"OUT", options->output}});
      const StoredVolume volume = options->volume.read_as_is(session);
      session.timed("write", [&] { write_volume(volume, options->output, options->write); });
    });
  });
}

}  // namespace isolux
