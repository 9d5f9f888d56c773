// sipplab documentation: the manual page and bash's completion, made from the same
// descriptions as --help. Packages call it; it is not listed.
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

/// Commands in the order of --help; hidden ones have no group.
std::vector<const CLI::App*> commands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); });
}

/// "plan", "findings list".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  const bool is_first = parent == nullptr || parent->get_parent() == nullptr;
  return is_first ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

/// A dash, a backslash or a dot at the beginning of a line mean something else to troff.
std::string troff(std::string_view text) {
  std::string page;
  bool begins_line = true;
  for (const char letter : text) {
    if (begins_line && (letter == '.' || letter == '\'')) page += "\\&";
    begins_line = letter == '\n';
    if (letter == '-') {
      page += "\\-";
    } else if (letter == '\\') {
      page += "\\e";
    } else {
      page += letter;
    }
  }
  return page;
}

std::string paragraphs(const std::string& text) {
  std::string lines = troff(text);
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 5) {
    lines.replace(at, 1, "\n.br\n");
  }
  return lines + "\n";
}

void add_options(const CLI::App& command, std::string& page) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    const bool takes_value = option->get_items_expected_max() > 0;
    page += ".TP\n.B " + troff(option->get_name(false, true)) +
            (takes_value ? " \\fI" + troff(option->get_type_name()) + "\\fR" : "") + "\n" +
            paragraphs(option->get_description());
  }
}

void add_command(const CLI::App& command, std::string& page) {
  page += ".SS " + troff(full_name(command)) + "\n" + paragraphs(command.get_description());
  add_options(command, page);
  if (const std::string footer = command.get_footer(); !footer.empty()) {
    page += ".PP\n.nf\n" + troff(footer) + "\n.fi\n";  // its lines are laid out: lists, columns
  }
  for (const CLI::App* inner : commands_of(command)) add_command(*inner, page);
}

std::string manual_page(const CLI::App& program) {
  std::string page = ".TH SIPPLAB 1 \"\" \"sipplab " SIPPLAB_VERSION
                     "\" \"User Commands\"\n"
                     ".SH NAME\nsipplab \\- planner for many disk-shaped robots, and its laboratory\n"
                     ".SH SYNOPSIS\n.B sipplab\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n" +
                     paragraphs(program.get_description()) + ".SH OPTIONS\n";
  add_options(program, page);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(program)) add_command(*command, page);
  return page +
         ".SH ENVIRONMENT\n.TP\n.B SIPPLAB_DB\nThe history file if \\-\\-db is not given; else "
         "./sipplab.db.\n.TP\n.B SIPPLAB_MACHINE\nThe name of this machine in histories; else its host "
         "name.\n";
}

/// What can follow the words of a command: its commands and its flags.
std::string words_after(const CLI::App& command) {
  std::string words;
  for (const CLI::App* inner : commands_of(command)) words += inner->get_name() + " ";
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& flag : option->get_lnames()) words += "--" + flag + " ";
    for (const std::string& flag : option->get_snames()) words += "-" + flag + " ";
  }
  if (!words.empty()) words.pop_back();
  return words;
}

void add_completions(const CLI::App& command, std::string& cases) {
  cases += fmt::format("    \"{}\") words=\"{}\" ;;\n",
                       command.get_parent() == nullptr ? "" : full_name(command), words_after(command));
  for (const CLI::App* inner : commands_of(command)) add_completions(*inner, cases);
}

std::string bash_completion(const CLI::App& program) {
  std::string cases;
  add_completions(program, cases);
  return "# bash completion of sipplab: commands and flags; file names for everything else.\n"
         "_sipplab() {\n"
         "  local words command='' word\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    case $word in -*) break ;; *) command+=${command:+ }$word ;; esac\n"
         "  done\n"
         "  case $command in\n" +
         cases +
         "    *) words='' ;;\n"
         "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"${COMP_WORDS[COMP_CWORD]}\")\n"
         "}\n"
         "complete -o default -F _sipplab sipplab\n";
}

}  // namespace

Command add_documentation_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("documentation", "write the manual page or bash's completion");
  command.group("");  // for packages, not for people
  struct Arguments {
    std::string kind, file;
  };
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("kind", arguments->kind, "man or bash")
      ->required()
      ->check(CLI::IsMember({"man", "bash"}));
  command.add_option("-o", arguments->file, "file to write")->required()->type_name("FILE");
  return {&command, [&program, arguments] {
            const std::string text =
                arguments->kind == "man" ? manual_page(program) : bash_completion(program);
            if (const auto error = write_file(arguments->file, text)) return fail(error->message());
            return static_cast<int>(kSuccess);
          }};
}

}  // namespace sipplab::cli
