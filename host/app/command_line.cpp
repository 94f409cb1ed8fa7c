#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "base/error.h"

namespace parhelion::app {

namespace {

/// CLI11 would only say that a command is missing.
void requireKnownCommand(const CLI::App& program, int argumentCount, char** arguments) {
    if (argumentCount < 2 || arguments[1][0] == '-') return;
    std::string names;
    for (const CLI::App* command : program.get_subcommands({})) {
        if (command->get_name() == arguments[1]) return;
        names += (names.empty() ? "" : ", ") + command->get_name();
    }
    throw InputError(fmt::format("expected a command: {}; got {}", names, arguments[1]));
}

}  // namespace

void Command::addFlag(const std::string& name, bool& target, const std::string& help) {
    command_->add_flag(name, target, help);
}

void Command::addArgument(const std::string& name, std::string& target, const std::string& help) {
    command_->add_option(name, target, help)->required()->type_name("");
}

void Command::addOption(const std::string& name, const std::string& placeholder, const std::string& help,
                        TakeText take) {
    command_->add_option_function<std::string>(name, take, help)->type_name(placeholder);
}

void Command::addRepeatedOption(const std::string& name, const std::string& placeholder, const std::string& help,
                                TakeText take) {
    command_
        ->add_option_function<std::vector<std::string>>(
            name,
            [take](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) take(text);
            },
            help)
        ->type_name(placeholder)
        ->allow_extra_args(false);
}

void Command::setFooter(const std::string& text) { command_->footer(text); }

bool Command::isChosen() const { return command_->parsed(); }

CommandLine::CommandLine(const std::string& name, const std::string& version, const std::string& description,
                         const std::string& footer)
    : program_(std::make_unique<CLI::App>(description, name)) {
    program_->set_version_flag("--version", name + " " + version);
    program_->require_subcommand(1);
    program_->footer(footer);
}

CommandLine::~CommandLine() = default;

Command CommandLine::addCommand(const std::string& name, const std::string& help) {
    return Command(*program_->add_subcommand(name, help));
}

std::optional<int> CommandLine::parse(int argumentCount, char** arguments) {
    requireKnownCommand(*program_, argumentCount, arguments);
    try {
        program_->parse(argumentCount, arguments);
        return std::nullopt;
    } catch (const CLI::Success& helpOrVersion) {
        return program_->exit(helpOrVersion);
    } catch (const CLI::ParseError& error) {
        const auto parsed = program_->get_subcommands();
        const std::string command = parsed.empty() ? "" : parsed.front()->get_name() + " ";
        throw InputError(fmt::format("{} (see parhelion {}--help)", error.what(), command));
    }
}

}  // namespace parhelion::app
