"""One module per verb: HELP, add_arguments(parser) and run(arguments, console) -> exit status; verbs.py lists them."""
