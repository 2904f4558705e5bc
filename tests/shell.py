"""A shell for scenes: newer versions of GCL take what system() is given apart at blanks, and start it themselves."""

SHELL = 'in_a_shell(command) := (with_stdout("command.sh", print(command)), system("sh command.sh"))$ '
