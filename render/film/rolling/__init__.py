"""How far pieces turn that roll on others."""
