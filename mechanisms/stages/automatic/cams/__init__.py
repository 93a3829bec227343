"""Bodies whose plate is a cam or a Geneva wheel, and what runs on it."""
