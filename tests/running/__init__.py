"""How the tests are run: what they need of the system, their order, what is shown of them; conftest.py takes it up."""
