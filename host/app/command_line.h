#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace parhelion::app {

/// A command of the program and what it takes. Hides the library that reads command lines, whose headers take longer
/// to compile than all else in this folder. A handle: copies mean the same command.
class Command {
public:
    using TakeText = std::function<void(const std::string& text)>;

    explicit Command(CLI::App& command) : command_(&command) {}

    /// Sets `target` when given.
    void addFlag(const std::string& name, bool& target, const std::string& help);
    /// What must be given by its position.
    void addArgument(const std::string& name, std::string& target, const std::string& help);
    /// An option with one text, which `take` gets while the command line is read; it may throw InputError.
    /// @param name         one or more, as "-o,--output".
    /// @param placeholder  what stands for the text in the help.
    void addOption(const std::string& name, const std::string& placeholder, const std::string& help, TakeText take);
    /// The same, for one that may be given several times.
    void addRepeatedOption(const std::string& name, const std::string& placeholder, const std::string& help,
                           TakeText take);
    /// What stands below the help.
    void setFooter(const std::string& text);
    bool isChosen() const;

private:
    CLI::App* command_;
};

/// The command line of the program: one command and its options.
class CommandLine {
public:
    CommandLine(const std::string& name, const std::string& version, const std::string& description,
                const std::string& footer);
    ~CommandLine();

    Command addCommand(const std::string& name, const std::string& help);

    /// Reads the arguments of main().
    /// @return an exit code when there is nothing left to do (--help, --version).
    /// @throws InputError for what no command or option allows.
    std::optional<int> parse(int argumentCount, char** arguments);

private:
    std::unique_ptr<CLI::App> program_;
};

}  // namespace parhelion::app
